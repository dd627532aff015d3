// Text from outside inside HTML, SVG and XML.
//
//   escaped("<b>5 & 6</b>");             // "&lt;b&gt;5 &amp; 6&lt;/b&gt;"
//
// XML 1.0 (section 2.2) has no place for control characters: all but line feed and tab are left out.
#pragma once
#include <string>
#include <string_view>

namespace omnihil {

std::string escaped(std::string_view text);

}  // namespace omnihil
