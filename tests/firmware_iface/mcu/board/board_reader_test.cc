// Board files: what is right is read, what is wrong is named with its place, all of it at once.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>

#include "firmware_iface/mcu/board/board_spec.h"
#include "firmware_iface/mcu/stm32/chip.h"
#include "tests/firmware_iface/mcu/board/boards_for_tests.h"
#include "tests/firmware_iface/mcu/board/dialects_for_tests.h"

namespace omnihil::mcu {
namespace {

const std::string kGood = R"(format = "omnihil-board/1"
name = "test"
chip = "STM32F407"

[[motor]]
wheel = 0
pwm = "TIM8.1"
inverted = true
direction = "PE1"
forward = "low"
encoder = "TIM3"

[[motor]]
wheel = 2
pwm = ["TIM1.1", "TIM1.2"]
reversed = true

[[device]]
kind = "nrf24l01"
name = "radio"
bus = "SPI1"
select = "PA4"
pins = { ce = "PB0", irq = "PB1" }

[[device]]
kind = "ina219"
bus = "I2C1"
settings = { shunt_ohm = 0.01 }

[[analog]]
adc = "ADC1"
channel = 3
signal = "bus_voltage"
volts_per_unit = 0.1

[[pin]]
pin = "PC13"
level = true

[[flash]]
address = 0x08060000
words = [1, 0xFFFFFFFF]

[radio]
format = "ulaval-hermes"
via = "radio"
)";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(BoardReader, ReadsWhatTheFileSays) {
  std::vector<BoardProblem> problems;
  const auto spec = read_board(kGood, "b.toml", problems);
  for (const BoardProblem& p : problems) ADD_FAILURE() << p.text();
  ASSERT_TRUE(spec);
  EXPECT_EQ(spec->chip->name, "stm32f405");
  ASSERT_EQ(spec->motors.size(), 2u);
  EXPECT_EQ(spec->motors[0].pwm[0].timer, "TIM8");
  EXPECT_TRUE(spec->motors[0].inverted);
  EXPECT_FALSE(spec->motors[0].direction_high_is_forward);
  EXPECT_EQ(spec->motors[1].sign, -1.0);
  ASSERT_EQ(spec->devices.size(), 2u);
  EXPECT_EQ(spec->devices[0].pins.at("irq").port, 'B');
  EXPECT_EQ(spec->devices[1].settings.at("shunt_ohm"), 0.01);
  EXPECT_EQ(spec->flash[0].words[1], 0xFFFFFFFFu);
  EXPECT_EQ(spec->radio_via, "radio");
}

TEST(BoardReader, ReadsThePhasesAndHallLinesOfAThreePhaseBoard) {
  const std::string text =
      replaced(kGood, "pwm = [\"TIM1.1\", \"TIM1.2\"]", R"(pwm = ["TIM1.1", "TIM1.2", "TIM1.3"]
pwm_low = ["TIM1.1N", "TIM1.2N", "TIM1.3N"]
hall = "TIM4"
hall_inverted = true
pole_pairs = 8)");
  std::vector<BoardProblem> problems;
  const auto spec = read_board(text, "b.toml", problems);
  for (const BoardProblem& p : problems) ADD_FAILURE() << p.text();
  ASSERT_TRUE(spec);
  ASSERT_EQ(spec->motors[1].pwm_low.size(), 3u);
  EXPECT_TRUE(spec->motors[1].pwm_low[2].complement);
  EXPECT_EQ(spec->motors[1].pwm_low[2].channel, 2u);
  EXPECT_TRUE(spec->motors[1].hall_inverted);
}

const std::string kWheelBoard = kTwoMotorBoard + R"([[flash]]
address = 0x0801F000
words = [7, 8]
board_number_at = 1

[wheel_commands]
dialect = "ibis-orion-can"
via = "CAN1"
reversed = true
)";

TEST(BoardReader, ReadsABoardThatIsSeveralTimesInARobot) {
  std::vector<BoardProblem> problems;
  const auto spec = read_board(kWheelBoard, "b.toml", problems, with_dialects());
  for (const BoardProblem& p : problems) ADD_FAILURE() << p.text();
  ASSERT_TRUE(spec);
  EXPECT_EQ(spec->boards_per_robot, 2);
  EXPECT_EQ(spec->flash[0].board_number_at, 1);
  EXPECT_EQ(spec->wheel_commands.words.frames.size(), 1u);
  EXPECT_EQ(spec->wheel_commands.via, "CAN1");
  EXPECT_EQ(spec->wheel_commands.sign, -1.0);
}

TEST(BoardReader, NamesWhatIsWrongWithWheelBoards) {
  const char* const kCases[][3] = {{"boards_per_robot = 2", "boards_per_robot = 3", "boards_per_robot"},
                                   {"wheel = 1", "wheel = 3", "boards_per_robot"},
                                   {"board_number_at = 1", "board_number_at = 2", "flash[0].board_number_at"},
                                   {"ibis-orion-can", "ibis", "wheel_commands.dialect"},
                                   {"\"CAN1\"", "\"USART1\"", "wheel_commands.via"},
                                   {"ibis-orion-can", "ateam-stspin-2025", "wheel_commands.via"}};
  for (const auto& [from, to, key] : kCases) {
    std::vector<BoardProblem> problems;
    EXPECT_FALSE(read_board(replaced(kWheelBoard, from, to), "b.toml", problems, with_dialects())) << to;
    ASSERT_EQ(problems.size(), 1u) << to;
    EXPECT_NE(problems[0].text().find(key), std::string::npos) << problems[0].text();
    // where the number stands that the key names
    const std::string text = replaced(kWheelBoard, from, to),
                      word = std::string(key).substr(std::string(key).rfind('.') + 1);
    const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<long>(text.find(word)), '\n');
    EXPECT_EQ(problems[0].line, line) << to;
  }
}

const char* const kMonitor = "kind = \"ina219\"\nbus = \"I2C1\"\nsettings = { shunt_ohm = 0.01 }\n";
const char* const kTwoCards =
    "kind = \"sd_card\"\nbus = \"SDIO\"\nimage = \"c\"\n[[device]]\nkind = \"sd_card\"\nname = "
    "\"other\"\nbus = "
    "\"SDIO\"\nimage = \"d\"\n";

struct Broken {
  const char *from, *to, *key, *what;
};

TEST(BoardReader, NamesEveryKindOfMistakeWithItsLineAndKey) {
  const Broken kCases[] = {
      {"omnihil-board/1", "omnihil-board/9", "format", "unknown"},
      {"STM32F407", "STM32F999", "chip", "unknown"},
      {"wheel = 2", "wheel = 4", "motor[1].wheel", "out of range"},
      {"wheel = 2", "wheel = 0", "motor[1].wheel", "used twice"},
      {"wheel = 2", "wheel = 1.5", "motor[1].wheel", "not a whole number"},
      {"reversed = true", "pwm_low = [\"TIM1.1N\"]", "motor[1].pwm_low", "not the lower gates"},
      {"\"TIM8.1\"", "\"TIM8.5\"", "motor[0].pwm", "no channel"},
      {"\"TIM8.1\"", "\"TIM77.1\"", "motor[0].pwm", "no channel"},
      {"\"TIM8.1\"", "\"TIM3.1N\"", "motor[0].pwm", "no channel"},
      {"\"TIM8.1\"", "\"TIM1.1\"", "motor[1].pwm", "used twice"},
      {"\"TIM8.1\"", "7", "motor[0].pwm", "not a text"},
      {"\"PE1\"", "\"PZ1\"", "motor[0].direction", "no pin"},
      {"\"PE1\"", "\"PE16\"", "motor[0].direction", "no pin"},
      {"\"low\"", "\"left\"", "motor[0].forward", "unknown"},
      {"encoder = \"TIM3\"", "encoder = \"TIM6\"", "motor[0].encoder", "no timer"},
      {"reversed = true", "reversed = 1", "motor[1].reversed", "not a truth value"},
      {"reversed = true", "hall = \"TIM4\"", "motor[1].pole_pairs", "missing"},
      {"reversed = true", "revesed = true", "motor[1].revesed", "unknown key"},
      {"\"nrf24l01\"", "\"nrf25\"", "device[0].kind", "unknown"},
      {"\"SPI1\"", "\"I2C1\"", "device[0].bus", "not an SPI"},
      {"select = \"PA4\"\n", "", "device[0].select", "missing"},
      {"ce = \"PB0\"", "cs = \"PB0\"", "device[0].pins.cs", "no such pin"},
      {"shunt_ohm = 0.01", "shunt = 0.01", "device[1].settings.shunt", "no such setting"},
      {"bus = \"I2C1\"", "bus = \"I2C1\"\nimage = \"card.img\"", "device[1].image", "holds no file"},
      {kMonitor, "kind = \"sd_card\"\nbus = \"SDIO\"\n", "device[1].image", "missing"},
      {kMonitor, "kind = \"sd_card\"\nbus = \"SDMMC1\"\nimage = \"c\"\n", "device[1].bus", "not an SDMMC"},
      {kMonitor, kTwoCards, "device[2].bus", "used twice"},
      {"\"ADC1\"", "\"ADC9\"", "analog[0].adc", "unknown"},
      {"\"bus_voltage\"", "\"voltage\"", "analog[0].signal", "unknown"},
      {"volts_per_unit = 0.1", "volts_per_unit = nan", "analog[0].volts_per_unit", "out of range"},
      {"level = true", "level = \"high\"", "pin[0].level", "not a truth value"},
      {"level = true", "robot_id_bit = 8", "pin[0].robot_id_bit", "out of range"},
      {"level = true", "level = true\nrobot_id_bit = 1", "pin[0].robot_id_bit", "beside a level"},
      {"level = true", "", "pin[0].level", "missing"},
      {"level = true", "break_beam = \"up\"", "pin[0].break_beam", "neither"},
      {"level = true", "level = true\nbreak_beam = \"low\"", "pin[0].break_beam", "beside a level"},
      {"omnihil-board/1\"", "omnihil-board/1\"\ncontrol_timer = \"TIM99\"", "control_timer", "no such timer"},
      {"0x08060000", "0x20000000", "flash[0].address", "out of range"},
      {"0x08060000", "0x08060002", "flash[0].address", "multiple of 4"},
      {"0xFFFFFFFF", "0x1FFFFFFFF", "flash[0].words", "not all are words"},
      {"via = \"radio\"", "via = \"ina219\"", "radio.via", "no radio"},
  };
  for (const Broken& c : kCases) {
    const std::string text = replaced(kGood, c.from, c.to);
    std::vector<BoardProblem> problems;
    EXPECT_FALSE(read_board(text, "b.toml", problems)) << c.to;
    bool found = false;
    for (const BoardProblem& p : problems) {
      found = found || (p.key == c.key && p.what.find(c.what) != std::string::npos);
      EXPECT_GT(p.line, 0u) << p.text();
      EXPECT_EQ(p.text().substr(0, 7), "b.toml:");
    }
    EXPECT_TRUE(found) << c.from << " -> " << c.to << ": " << (problems.empty() ? "" : problems[0].text());
  }
}

// What is refused is not in the list of what is allowed.
TEST(BoardReader, AListOfWhatIsAllowedDoesNotNameWhatItRefuses) {
  struct Refused {
    const char *from, *to, *key, *name;
  };
  for (const Refused& c :
       {Refused{"encoder = \"TIM3\"", "encoder = \"TIM6\"", "motor[0].encoder", "TIM6"},
        Refused{"encoder = \"TIM3\"", "encoder = \"TIM13\"", "motor[0].encoder", "TIM13"},
        Refused{"reversed = true", "hall = \"TIM9\"\npole_pairs = 4", "motor[1].hall", "TIM9"},
        Refused{"\"TIM8.1\"", "\"TIM7.1\"", "motor[0].pwm", "TIM7"},
        Refused{"\"TIM8.1\"", "\"TIM3.1N\"", "motor[0].pwm", "TIM3"},
        Refused{"\"SPI1\"", "\"I2C1\"", "device[0].bus", "I2C1"}}) {
    std::vector<BoardProblem> problems;
    EXPECT_FALSE(read_board(replaced(kGood, c.from, c.to), "b.toml", problems)) << c.to;
    const auto it =
        std::find_if(problems.begin(), problems.end(), [&](const BoardProblem& p) { return p.key == c.key; });
    ASSERT_NE(it, problems.end()) << c.to;
    EXPECT_FALSE(it->allowed.empty()) << c.to;
    EXPECT_EQ((it->allowed + ",").find(std::string(c.name) + ","), std::string::npos) << it->text();
  }
}

TEST(BoardReader, CollectsAllMistakesOfAFile) {
  std::string text = replaced(kGood, "\"TIM8.1\"", "\"TIM9.3\"");
  text = replaced(text, "\"SPI1\"", "\"SPI9\"");
  text = replaced(text, "wheel = 2", "wheel = 9");
  std::vector<BoardProblem> problems;
  EXPECT_FALSE(read_board(text, "b.toml", problems));
  EXPECT_EQ(problems.size(), 3u);
}

TEST(BoardReader, TextThatIsNoTomlIsOneProblemWithItsLine) {
  std::vector<BoardProblem> problems;
  EXPECT_FALSE(read_board("format = \"omnihil-board/1\"\nname = \n", "b.toml", problems));
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_EQ(problems[0].line, 2u);
}

TEST(BoardReader, SurvivesAThousandMutations) {
  std::mt19937 random(7);
  int refused = 0;
  for (int i = 0; i < 1000; ++i) {
    std::string text = kGood;
    for (unsigned n = 0; n < 1 + random() % 4; ++n) {
      const std::size_t at = random() % text.size();
      if (random() % 3 == 0) {
        text.erase(at, random() % 20);
      } else {
        text[at] = static_cast<char>(random() % 256);
      }
    }
    std::vector<BoardProblem> problems;
    const auto spec = read_board(text, "b.toml", problems);
    EXPECT_EQ(spec.has_value(), problems.empty());
    refused += spec ? 0 : 1;
  }
  EXPECT_GT(refused, 500);
}

}  // namespace
}  // namespace omnihil::mcu
