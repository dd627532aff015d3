#include "hil/text/markup.h"

#include <gtest/gtest.h>

namespace omnihil {
namespace {

TEST(MarkupTest, NothingFromOutsideIsMarkup) {
  EXPECT_EQ(escaped("<a href=\"x\" id='y'>5 & 6</a>"),
            "&lt;a href=&quot;x&quot; id=&#39;y&#39;&gt;5 &amp; 6&lt;/a&gt;");
}

TEST(MarkupTest, ControlCharactersThatXmlForbidsAreLeftOut) {
  EXPECT_EQ(escaped(std::string("a\0b\x1b[1mc\td\n", 11)), "ab[1mc\td\n");
}

}  // namespace
}  // namespace omnihil
