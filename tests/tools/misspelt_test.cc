// What the program answers to verbs and options that do not exist.
#include <sstream>

#include "tests/tools/cli.h"

namespace omnihil {
namespace {

class MisspeltTest : public CliTest {};

TEST_F(MisspeltTest, AMistypedVerbIsAnsweredWithTheNearestOne) {
  const Ran ran = run_omnihil("srve --robots 0");
  EXPECT_EQ(ran.exit_code, 2);
  EXPECT_EQ(ran.text, "omnihil: there is no verb \"srve\"; did you mean \"serve\"?\n");
}

TEST_F(MisspeltTest, AMistypedVerbOfAVerbIsAnsweredToo) {
  const Ran ran = run_omnihil("scenario rnu");
  EXPECT_EQ(ran.exit_code, 2);
  EXPECT_EQ(ran.text, "omnihil scenario: there is no verb \"rnu\"; did you mean \"run\"?\n");
}

TEST_F(MisspeltTest, EveryMistypedOptionIsAnsweredWithTheNearestOne) {
  const Ran ran = run_omnihil("serve --robts 0-2 --colour=red --tem blue");
  EXPECT_EQ(ran.exit_code, 2);
  EXPECT_EQ(ran.text,
            "omnihil serve: there is no option --robts; did you mean --robots?\n"
            "omnihil serve: there is no option --colour; `omnihil serve --help` lists them\n"
            "omnihil serve: there is no option --tem; did you mean --team?\n");
}

TEST_F(MisspeltTest, OptionsAreSoughtAmongThoseOfTheVerbThatWasCalled) {
  // --levels is near --level, which `scenario run` has and `scenario` has not.
  EXPECT_EQ(run_omnihil("scenario run --levels wheel").text,
            "omnihil scenario run: there is no option --levels; did you mean --level?\n");
  EXPECT_EQ(run_omnihil("--verzion").text,
            "omnihil: there is no option --verzion; did you mean --version?\n");
}

TEST_F(MisspeltTest, TheAnswerComesBeforeWhatElseIsMissing) {
  const Ran ran = run_omnihil("fit --hlep");  // without its dataset
  EXPECT_EQ(ran.exit_code, 2);
  EXPECT_EQ(ran.text, "omnihil fit: there is no option --hlep; did you mean --help?\n");
}

TEST_F(MisspeltTest, HiddenVerbsAreNotAdvertised) {
  EXPECT_EQ(run_omnihil("manuel").text.find("manual"), std::string::npos);
  EXPECT_FALSE(run_omnihil("--help").says("manual"));
}

TEST_F(MisspeltTest, ANegativeNumberIsNoOption) { EXPECT_FALSE(run_omnihil("serve -1.5").says("no option")); }

}  // namespace
}  // namespace omnihil
