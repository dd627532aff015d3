// Variables of programs that the test compiles and runs: each value is what the program's own code put there.
#include "hil/variables/debug_info.h"

#include <cstddef>
#include <limits>

#include "tests/hil/variables/built_program.h"
#include "tests/hil/variables/program/names.h"

namespace omnihil {
namespace {

// Each version of DWARF, the compiler's usual ways of making it small, and with the optimiser.
class DebugInfoTest : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Flags, DebugInfoTest,
                         testing::Values("-O0 -gdwarf-2 -gstrict-dwarf", "-O0 -gdwarf-3 -gstrict-dwarf",
                                         "-O2 -gdwarf-4", "-O2 -gdwarf-5", "-O2 -g -gz",
                                         "-O2 -g -fdebug-types-section",
                                         "-O3 -g -fdata-sections -Wl,--gc-sections"));

TEST_P(DebugInfoTest, EveryKindOfValueIsWhatTheProgramPutThere) {
  BuiltProgram program(GetParam(), {"names.c", "names_other.c"});
  program.fill();
  for (int i = 0; i < 4; ++i) {
    const std::string w = "wheel[" + std::to_string(i) + "]";
    EXPECT_EQ(program.number(w + ".last"), -100 - i);
    EXPECT_EQ(program.number(w + ".gains.kp"), 0.5 + i);
    EXPECT_EQ(program.number(w + ".gains.ki"), -0.125 * i);
    EXPECT_EQ(program.number(w + ".integral"), 0.25 * i);
    EXPECT_EQ(program.number(w + ".level"), 5);
    EXPECT_EQ(program.number(w + ".trim"), -9);
    EXPECT_EQ(program.number(w + ".wide"), static_cast<double>(0x123456789AULL + static_cast<unsigned>(i)));
    EXPECT_EQ(program.text(w + ".on"), i % 2 == 1 ? "true" : "false");
    EXPECT_EQ(program.text(w + ".mode"), i == 0 ? "kNamesIdle" : i == 1 ? "kNamesDriving" : "kNamesBraking");
    EXPECT_EQ(program.number(w + ".mode"), i == 0 ? -1 : i == 1 ? 3 : 200);
    EXPECT_EQ(program.text(w + ".flag"), i == 3 ? "kNamesHigh" : "kNamesLow");
    EXPECT_EQ(program.text(w + ".label"), "0x0000000000001234");
    EXPECT_EQ(program.number(w + ".word"), 0x04030201);
    EXPECT_EQ(program.number(w + ".byte[2]"), 3);
    for (int j = 0; j < 6; ++j) {
      const std::string at = "[" + std::to_string(j / 3) + "][" + std::to_string(j % 3) + "]";
      EXPECT_EQ(program.number(w + ".table" + at), 10 * i + j - 3);
    }
  }
  EXPECT_EQ(program.text("far_below"), std::to_string(std::numeric_limits<std::int64_t>::min() + 5));
  EXPECT_EQ(program.number("counter"), 250);
  EXPECT_EQ(program.number("calls_of::calls"), 7);
  EXPECT_EQ(program.number("kept"), 42);
  EXPECT_EQ(program.number("names.c:shared"), 1.5);
}

TEST_P(DebugInfoTest, PlacesAreThoseOfTheCompilersOwnLayout) {
  BuiltProgram program(GetParam(), {"names.c"});
  std::string problem;
  const auto begin = program.names->find("wheel", problem);
  const auto integral = program.names->find("wheel[3].integral", problem);
  const auto table = program.names->find("wheel[1].table[1]", problem);
  ASSERT_TRUE(begin && integral && table) << problem;
  EXPECT_EQ(begin->piece.bytes, 4 * sizeof(names_wheel));
  EXPECT_EQ(integral->piece.address - begin->piece.address,
            3 * sizeof(names_wheel) + offsetof(names_wheel, integral));
  EXPECT_EQ(table->piece.address - begin->piece.address,
            sizeof(names_wheel) + offsetof(names_wheel, table) + 3 * sizeof(std::int16_t));
  EXPECT_EQ(table->piece.bytes, 3 * sizeof(std::int16_t));
}

TEST_P(DebugInfoTest, AWriteChangesItsOwnBitsAlone) {
  BuiltProgram program(GetParam(), {"names.c"});
  program.fill();
  EXPECT_EQ(program.set("wheel[2].trim", "-16"), "");
  EXPECT_EQ(program.set("wheel[2].level", "0x7"), "");
  EXPECT_EQ(program.set("wheel[2].wide", "0x1fffffffff"), "");
  EXPECT_EQ(program.set("wheel[2].mode", "kNamesIdle"), "");
  EXPECT_EQ(program.set("wheel[2].on", "true"), "");
  EXPECT_EQ(program.set("wheel[2].gains.ki", "-1.5e-3"), "");
  EXPECT_EQ(program.set("far_below", "-9223372036854775808"), "");
  EXPECT_EQ(program.number("wheel[2].trim"), -16);
  EXPECT_EQ(program.number("wheel[2].level"), 7);
  EXPECT_EQ(program.number("wheel[2].wide"), static_cast<double>(0x1FFFFFFFFFULL));
  EXPECT_EQ(program.number("wheel[2].mode"), -1);
  EXPECT_EQ(program.text("wheel[2].on"), "true");
  EXPECT_EQ(program.number("wheel[2].gains.ki"), -1.5e-3);
  EXPECT_EQ(program.text("far_below"), "-9223372036854775808");
  EXPECT_EQ(program.number("wheel[2].last"), -102);  // what lies around them
  EXPECT_EQ(program.number("wheel[2].integral"), 0.5);
  EXPECT_EQ(program.text("wheel[2].flag"), "kNamesLow");
  EXPECT_EQ(program.number("wheel[1].trim"), -9);
}

TEST_P(DebugInfoTest, AValueThatDoesNotFitIsRefusedWithWhatIsAllowed) {
  BuiltProgram program(GetParam(), {"names.c"});
  program.fill();
  EXPECT_NE(program.set("counter", "256").find("allowed: 0 to 255"), std::string::npos);
  EXPECT_NE(program.set("wheel[0].trim", "16").find("allowed: -16 to 15"), std::string::npos);
  EXPECT_NE(program.set("wheel[0].mode", "kNamesFlying").find("kNamesBraking"), std::string::npos);
  EXPECT_NE(program.set("wheel[0].integral", "much").find("a number"), std::string::npos);
  EXPECT_NE(program.set("kept", "1").find("constant"), std::string::npos);
  EXPECT_EQ(program.number("counter"), 250);
}

// What has no single place is said by name.
TEST(DebugInfoWordsTest, WhatCannotBeHadIsSaid) {
  BuiltProgram program("-O2 -g -fdata-sections -Wl,--gc-sections", {"names.c", "names_other.c"});
  EXPECT_NE(program.text("local").find("is a local of names_fill()"), std::string::npos);
  EXPECT_NE(program.text("argument").find("is a local of names_fill()"), std::string::npos);
  EXPECT_NE(program.text("per_thread").find("thread-local"), std::string::npos);
  EXPECT_NE(program.text("never_used[1]").find("removed by the linker"), std::string::npos)
      << program.text("never_used[1]");
  EXPECT_NE(program.text("whel[2].integral").find("did you mean \"wheel\""), std::string::npos);
  EXPECT_NE(program.text("wheel[2].integrall").find("it has .integral,"), std::string::npos)
      << program.text("wheel[2].integrall");
  EXPECT_NE(program.text("wheel[4].last").find("allowed: [0] to [3]"), std::string::npos);
  EXPECT_NE(program.text("wheel[-1].last").find("is no index"), std::string::npos);
  EXPECT_NE(program.text("wheel.last").find("no member"), std::string::npos);
  EXPECT_NE(program.text("wheel[1]").find("no single value; it has .last"), std::string::npos);
  EXPECT_NE(program.text("wheel[1].last[0]").find("no array"), std::string::npos);
  EXPECT_NE(program.text("counter@1").find("allowed: @0 to @0"), std::string::npos);
  EXPECT_NE(program.text("other.c:counter").find("file other.c"), std::string::npos);
}

TEST(DebugInfoWordsTest, ANameOfTwoFilesIsToldApart) {
  BuiltProgram program("-O0 -g", {"names.c", "names_other.c"});
  program.fill();
  const std::string both = program.text("shared");
  EXPECT_NE(both.find("names.c:shared"), std::string::npos) << both;
  EXPECT_NE(both.find("names_other.c:shared"), std::string::npos) << both;
  EXPECT_EQ(program.number("names.c:shared"), 1.5);
  EXPECT_EQ(program.number("names_other.c:shared"), 0.0);
}

// What the compiler makes of them is its own affair, so each answer that is true will do.
TEST(DebugInfoWordsTest, WhatTheOptimiserRemovedIsNamedOrHasItsValue) {
  BuiltProgram program("-O2 -g", {"gone.c"});
  program.fill();
  for (const char* name : {"gone", "frozen"}) {
    const std::string said = program.text(name);
    EXPECT_TRUE(said.find("optimiser") != std::string::npos || said == "3" || said == "17")
        << name << ": " << said;
  }
  EXPECT_EQ(program.number("seen"), 20);  // 17 + 3
}

TEST(DebugInfoWordsTest, NamesOfCppAreThoseOfItsSource) {
  BuiltProgram program("-O0 -g", {"names.cc"});
  program.fill();
  EXPECT_EQ(program.number("robot::Wheel::count"), 4);
  EXPECT_EQ(program.number("robot::front.id"), 11);  // of the base class
  EXPECT_EQ(program.number("robot::front.speed"), 2.5);
  EXPECT_EQ(program.text("robot::mode"), "kOn");
  EXPECT_EQ(program.number("names_fill::calls"), 1);
  EXPECT_EQ(program.number("robot::Filter<3>::gain"), 1.5);
}

TEST(DebugInfoWordsTest, FilesWithoutDebugInformationAreRefused) {
  BuiltProgram program("-O0 -g", {"names.c"});
  std::string problem;
  std::vector<std::uint8_t> stripped;
  {
    const std::string copy = program.path.string() + ".stripped";
    ASSERT_EQ(std::system(("strip -g -o '" + copy + "' '" + program.path.string() + "'").c_str()), 0);
    stripped = bytes_of(copy);
    std::filesystem::remove(copy);
  }
  EXPECT_EQ(DebugInfo::read(stripped, problem), nullptr);
  EXPECT_NE(problem.find("compile and link it with -g"), std::string::npos) << problem;
  EXPECT_EQ(DebugInfo::read({'n', 'o'}, problem), nullptr);
  EXPECT_NE(problem.find("no ELF"), std::string::npos) << problem;
  EXPECT_EQ(DebugInfo::read({}, problem), nullptr);
}

// All values of a whole array of structs, once each.
TEST(DebugInfoWordsTest, AStructStandsForAllItsValues) {
  BuiltProgram program("-O0 -g", {"names.c"});
  std::string problem;
  const auto wheel = program.names->find("wheel[1]", problem);
  ASSERT_TRUE(wheel) << problem;
  const auto values = program.names->values_of(*wheel, 1000);
  // last, kp, ki, integral, level, trim, wide, on, mode, flag, label, word, 4 bytes, 6 of the table
  EXPECT_EQ(values.size(), 22u);
  EXPECT_EQ(values.front().name, "wheel[1].last");
  EXPECT_EQ(values.back().name, "wheel[1].table[1][2]");
  EXPECT_EQ(program.names->values_of(*wheel, 5).size(), 5u);
}

}  // namespace
}  // namespace omnihil
