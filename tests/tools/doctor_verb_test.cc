// omnihil doctor, as a user runs it.
#include <nlohmann/json.hpp>

#include "hil/text/json_text.h"
#include "tests/tools/cli.h"

namespace omnihil {
namespace {

class DoctorVerb : public CliTest {};

TEST_F(DoctorVerb, SaysEveryFindingWithAWordOfItsState) {
  const Ran ran = run_omnihil("doctor");
  EXPECT_EQ(ran.exit_code, 0) << ran.text;
  for (const char* what :
       {"pseudo-terminals", "serial ports", "SocketCAN", "clock", "waking up", "real-time priority",
        "locked memory", "open files", "league ports", "vision port", "multicast", "Wireshark"})
    EXPECT_TRUE(ran.says(what)) << what << "\n" << ran.text;
}

TEST_F(DoctorVerb, StrictFailsJustWhenSomethingIsMissing) {
  const Ran ran = run_omnihil("doctor --strict --json");
  bool missing = false;
  const auto said = json_of(ran.text);
  ASSERT_FALSE(said["findings"].empty());
  for (const auto& finding : said["findings"]) {
    const std::string state = finding["state"];
    EXPECT_TRUE(state == "ok" || state == "limited" || state == "missing") << state;
    EXPECT_EQ(finding["mend"] == "", state == "ok") << finding.dump();
    missing = missing || state == "missing";
  }
  EXPECT_EQ(ran.exit_code, missing ? 1 : 0) << ran.text;
}

}  // namespace
}  // namespace omnihil
