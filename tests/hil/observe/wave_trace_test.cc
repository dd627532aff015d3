// Signals as VCD: read by sigrok-cli, whose decoders have to find what the machine says was sent, and by a small reader of our own for
// what sigrok leaves out (numbers, words).
#include "hil/observe/wave_trace.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "firmware_iface/mcu/stm32/can.h"
#include "firmware_iface/mcu/stm32/usart.h"
#include "hil/observe/vcd_text.h"
#include "tests/hil/observe/image_program.h"
#include "tests/hil/observe/sigrok.h"

namespace omnihil {
namespace {

namespace fs = std::filesystem;

// Changes of each signal by name, in order; of a word its bits.
struct ReadBack {
  std::map<std::string, std::vector<std::pair<std::int64_t, std::string>>> of;
  bool in_order = true;
  std::int64_t first_ns = -1, last_ns = -1;
};

ReadBack read_back(const std::string& text) {
  ReadBack back;
  std::map<std::string, std::string> names;
  std::istringstream words(text);
  std::int64_t now_ns = 0;
  bool defined = false;
  for (std::string word; words >> word;) {
    if (word == "$enddefinitions") defined = true;
    if (word == "$var") {
      std::string kind, bits, code, name;
      words >> kind >> bits >> code >> name;
      names[code] = name;
    } else if (!defined) {
      continue;
    } else if (word[0] == '#') {
      const std::int64_t at_ns = std::stoll(word.substr(1));
      back.in_order = back.in_order && (back.first_ns < 0 || at_ns > now_ns);
      back.last_ns = now_ns = at_ns;
      if (back.first_ns < 0) back.first_ns = at_ns;
    } else if (word[0] == 'b' || word[0] == 'r') {
      std::string code;
      words >> code;
      back.of[names.at(code)].emplace_back(now_ns, word.substr(1));
    } else if (word[0] == '0' || word[0] == '1' || word[0] == 'z') {
      if (names.contains(word.substr(1)))
        back.of[names.at(word.substr(1))].emplace_back(now_ns, word.substr(0, 1));
    }
  }
  return back;
}

class WaveTraces : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("omnihil_waves_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path written(const std::string& text) const {
    std::ofstream(folder_ / "t.vcd") << text;
    return folder_ / "t.vcd";
  }
  fs::path folder_;
};

class ImageWaves : public WaveTraces {
 protected:
  void SetUp() override {
    WaveTraces::SetUp();
    if (!fs::exists(kReferenceImage)) GTEST_SKIP() << "arm-none-eabi-gcc is not installed";
  }
};

TEST_F(WaveTraces, TheFileSaysEachChangeOnceAndInOrder) {
  WaveLog log({});
  const int a = log.add("robot0", "A", WaveKind::kLevel, 1, {1, false});
  const int word = log.add("robot0", "word", WaveKind::kWord, 8);
  const int real = log.add("robot1.board0", "real", WaveKind::kReal);
  log.add("robot1.board0", "never", WaveKind::kLevel);
  log.put(word, 20, 0xA5);
  log.put(a, 10, 0);  // of another signal, before
  log.put(a, 30, 0);  // no change
  log.put_real(real, 20, -0.25);
  log.put_none(word, 40);
  log.reaches(50);
  const std::string text = vcd_text(log);
  EXPECT_EQ(text.substr(text.find("$enddefinitions")),
            "$enddefinitions $end\n#0\n$dumpvars\n1!\nbz \"\nr0 #\n$end\n"
            "#10\n0!\n#20\nb10100101 \"\nr-0.25 #\n#40\nbz \"\n#50\n");
  EXPECT_EQ(text.find("never"), std::string::npos);
  EXPECT_NE(
      text.find(
          "$scope module robot1 $end\n$scope module board0 $end\n$var real 64 # robot1_board0_real $end\n"
          "$upscope $end\n$upscope $end\n"),
      std::string::npos)
      << text;
}

// What has left the stretch is the value with which the rest begins.
TEST_F(WaveTraces, OfTheLastStretchTheBeginIsWhatWasThere) {
  WaveLog log({.last_s = 1e-6});
  const int a = log.add("robot0", "A", WaveKind::kLevel, 1, {0, false});
  for (int i = 0; i < 100; ++i) log.put(a, 100 * i, i % 2 == 0 ? 1 : 0);
  log.reaches(10'000);
  const ReadBack back = read_back(vcd_text(log));
  EXPECT_EQ(back.first_ns, 9'000);
  EXPECT_EQ(back.last_ns, 10'000);
  const auto& changes = back.of.at("A");
  ASSERT_EQ(changes.size(), 1u + 9u);  // at 9,000 what 9,000 has; 9,100 to 9,900
  EXPECT_EQ(changes.front().second, "1");
  EXPECT_EQ(changes.back(), (std::pair<std::int64_t, std::string>{9'900, "0"}));
}

TEST_F(WaveTraces, TooManyEventsLeaveTheNewestAndSaySo) {
  WaveLog log({.last_s = 0.0, .filter = "", .most = 10});
  const int a = log.add("robot0", "A", WaveKind::kLevel);
  for (int i = 0; i < 100; ++i) log.put(a, i, i % 2);
  EXPECT_TRUE(log.dropped());
  EXPECT_EQ(log.events().size(), 10u);
  EXPECT_EQ(read_back(vcd_text(log)).last_ns, 99);
}

TEST_F(ImageWaves, AWatchedRunIsTheSameRun) {
  ObservedImage plain, watched;
  WaveTrace trace({});
  trace.begins(*watched.firmware, watched.elf, 0);
  plain.run_ms(200);
  watched.run_ms(200);
  const mcu::MachineReport a = plain.machine().report(), b = watched.machine().report();
  EXPECT_EQ(a.instructions, b.instructions);
  EXPECT_EQ(a.thread_cycles, b.thread_cycles);
  EXPECT_EQ(a.sleep_cycles, b.sleep_cycles);
  EXPECT_EQ(plain.machine().now(), watched.machine().now());
  EXPECT_TRUE(plain.machine().cpu().reg == watched.machine().cpu().reg);
  trace.ends(*watched.firmware);
  EXPECT_GT(trace.events(), 100u);
}

// The interrupt's line rises as often as the machine has entered it, and is high for as long as it counted.
TEST_F(ImageWaves, AnInterruptsLineIsHighWhileItRuns) {
  ObservedImage run;
  WaveTrace trace({.last_s = 0.0, .filter = "IRQ54"});
  trace.begins(*run.firmware, run.elf, 0);
  run.run_ms(100);
  trace.ends(*run.firmware);
  const mcu::InterruptLoad load = run.machine().report().exceptions.at(16 + 54);
  const ReadBack back = read_back(trace.text());
  EXPECT_TRUE(back.in_order);
  EXPECT_EQ(back.of.size(), 1u);
  std::uint64_t count = 0;
  std::int64_t high_ns = 0, since_ns = 0;
  for (const auto& [at_ns, level] : back.of.at("IRQ54")) {
    if (level == "1") {
      ++count;
      since_ns = at_ns;
    } else if (count > 0) {
      high_ns += at_ns - since_ns;
    }
  }
  EXPECT_EQ(count, load.count);
  EXPECT_NEAR(static_cast<double>(high_ns), static_cast<double>(load.busy) / 168e6 * 1e9,
              0.02 * static_cast<double>(high_ns));
}

// What the radio brought and what the robot answered, as sigrok's UART decoder reads it from the lines.
TEST_F(ImageWaves, SigrokReadsTheBytesOfASerialPort) {
  if (!has_sigrok()) GTEST_SKIP() << "sigrok-cli is not installed";
  ObservedImage run, other;
  WaveTrace levels({.last_s = 0.0, .filter = "USART1", .levels_only = true}),
      all({.last_s = 0.0, .filter = "USART1"});
  levels.begins(*run.firmware, run.elf, 0);
  all.begins(*other.firmware, other.elf, 0);
  run.run_ms(20);
  other.run_ms(20);
  const std::vector<std::uint8_t> sent{0x55, 0x00, 0xFF, 0x81, 0x0A, 0x00};
  for (ObservedImage* image : {&run, &other}) {
    image->firmware->radio_receive(sent, 20'000'000);
    image->run_ms(10);
  }
  const double baud = run.firmware->board(0).chip().find<mcu::Usart>("USART1")->baud();
  levels.ends(*run.firmware);
  all.ends(*other.firmware);
  const std::vector<std::string> said =
      sigrok_says(written(levels.text()),
                  fmt::format("-P uart:rx=USART1_RX:baudrate={:.0f}:format=hex -A uart=rx-data", baud));
  EXPECT_EQ(said, (std::vector<std::string>{"55", "00", "FF", "81", "0A", "00"}));
  const ReadBack back = read_back(all.text());
  std::vector<std::string> bytes;
  for (const auto& [at_ns, bits] : back.of.at("USART1_RX_byte"))
    if (bits != "z") bytes.push_back(bits);
  EXPECT_EQ(bytes, (std::vector<std::string>{"1010101", "0", "11111111", "10000001", "1010", "0"}));
}

void set(ObservedImage& run, std::uint32_t address, std::uint32_t value) {
  run.machine().bus_write(address, 4, value);
}

// Every mode of the clock: what the master sends, what comes back with nobody there.
TEST_F(ImageWaves, SigrokReadsTheWordsOfAnSpiInEveryMode) {
  if (!has_sigrok()) GTEST_SKIP() << "sigrok-cli is not installed";
  for (const unsigned mode : {0u, 1u, 2u, 3u}) {
    ObservedImage run;
    WaveTrace trace({.last_s = 0.0, .filter = "SPI1"});
    trace.begins(*run.firmware, run.elf, 0);
    run.run_ms(10);
    constexpr std::uint32_t kSpi1 = 0x40013000;
    const unsigned cpol = mode >> 1, cpha = mode & 1;
    set(run, kSpi1, 1u << 2 | 4u << 3 | 3u << 8 | 1u << 6 | cpol << 1 | cpha);  // master, /32, on
    for (const std::uint32_t byte : {0xA5u, 0x3Cu, 0x01u}) {
      set(run, kSpi1 + 0x0C, byte);
      run.run_ms(1);
    }
    trace.ends(*run.firmware);
    const std::string options =
        fmt::format("-P spi:clk=SPI1_SCK:mosi=SPI1_MOSI:miso=SPI1_MISO:cpol={}:cpha={} -A spi=", cpol, cpha);
    const fs::path file = written(trace.text());
    EXPECT_EQ(sigrok_says(file, options + "mosi-data"), (std::vector<std::string>{"A5", "3C", "01"})) << mode;
    EXPECT_EQ(sigrok_says(file, options + "miso-data"), (std::vector<std::string>{"FF", "FF", "FF"})) << mode;
  }
}

// Two pins of a bridge's half with dead time: each is high for its share less the dead time, and never both.
TEST_F(ImageWaves, SigrokMeasuresThePulsesOfATimer) {
  if (!has_sigrok()) GTEST_SKIP() << "sigrok-cli is not installed";
  ObservedImage run;
  WaveTrace levels({.last_s = 0.0, .filter = "TIM8_CH1", .levels_only = true});
  levels.begins(*run.firmware, run.elf, 0);
  run.run_ms(10);
  constexpr std::uint32_t kTim8 = 0x40010400;
  set(run, kTim8 + 0x2C, 1679);            // ARR: 1680 clocks of 168 MHz, 10 us
  set(run, kTim8 + 0x34, 420);             // CCR1: a quarter
  set(run, kTim8 + 0x18, 6u << 4);         // PWM mode 1
  set(run, kTim8 + 0x20, 1u | 1u << 2);    // CC1E, CC1NE
  set(run, kTim8 + 0x44, 84u | 1u << 15);  // dead time 84 clocks, 0.5 us; MOE
  set(run, kTim8, 1);
  run.run_ms(1);
  levels.ends(*run.firmware);
  const fs::path file = written(levels.text());
  const auto most_seen = [&](const char* pin) {
    std::map<std::string, int> seen;
    for (const std::string& line : sigrok_says(file, fmt::format("-P pwm:data={}", pin)))
      if (line.ends_with('%')) ++seen[line];
    return std::ranges::max_element(seen, {}, [](const auto& one) { return one.second; })->first;
  };
  EXPECT_NEAR(std::stod(most_seen("TIM8_CH1")), 100.0 * (420 - 84) / 1680, 0.02);
  EXPECT_NEAR(std::stod(most_seen("TIM8_CH1N")), 100.0 * (1680 - 420 - 84) / 1680, 0.02);
  const ReadBack back = read_back(levels.text());
  EXPECT_EQ(back.of.size(), 2u);
  std::map<std::int64_t, std::pair<int, int>> moves;  // of main, of complement
  for (const auto& [at_ns, level] : back.of.at("TIM8_CH1")) moves[at_ns].first = level == "1" ? 1 : -1;
  for (const auto& [at_ns, level] : back.of.at("TIM8_CH1N")) moves[at_ns].second = level == "1" ? 1 : -1;
  int main = -1, complement = -1, both = 0;
  for (const auto& [at_ns, move] : moves) {
    if (move.first != 0) main = move.first;
    if (move.second != 0) complement = move.second;
    both += main > 0 && complement > 0;
  }
  EXPECT_EQ(both, 0);
  EXPECT_GT(moves.size(), 300u);
}

// A frame out and two in at one instant, with stuff bits and check sums that sigrok's decoder accepts.
TEST_F(ImageWaves, SigrokReadsTheFramesOfACan) {
  if (!has_sigrok()) GTEST_SKIP() << "sigrok-cli is not installed";
  ObservedImage run;
  WaveTrace trace({.last_s = 0.0, .filter = "CAN1", .levels_only = true});
  trace.begins(*run.firmware, run.elf, 0);
  run.run_ms(10);
  constexpr std::uint32_t kCan1 = 0x40006400;
  set(run, kCan1, 1);
  set(run, kCan1 + 0x1C, 5u | 9u << 16 | 2u << 20);  // 42 MHz / 6 / (3 + 9 + 2) = 500 kbit/s
  set(run, kCan1, 0);
  set(run, kCan1 + 0x184, 4);
  set(run, kCan1 + 0x188, 0x00FF0000);
  set(run, kCan1 + 0x180, 0x123u << 21 | 1);
  run.run_ms(1);
  mcu::CanFrame come{.id = 0x1ABCDE, .extended = true, .bytes = 2, .data = {0xDE, 0xAD}};
  auto& can = *run.firmware->board(0).chip().find<mcu::CanPort>("CAN1");
  can.receive(come);
  can.receive({.id = 0x6FF, .bytes = 1, .data = {0}});
  run.run_ms(1);
  trace.ends(*run.firmware);
  const fs::path file = written(trace.text());
  const std::string options = "-P can:can_rx=CAN1:nominal_bitrate=500000 -A can=";
  EXPECT_EQ(sigrok_says(file, options + "full-id").size(), 1u);
  const auto says = [&](const char* which) {
    return fmt::format("{}", fmt::join(sigrok_says(file, options + which), "|"));
  };
  EXPECT_EQ(says("data"),
            "Data byte 0: 0x00|Data byte 1: 0x00|Data byte 2: 0xff|Data byte 3: 0x00|"
            "Data byte 0: 0xde|Data byte 1: 0xad|Data byte 0: 0x00");
  EXPECT_NE(says("full-id").find("0x1abcde"), std::string::npos) << says("full-id");
  EXPECT_NE(says("id").find("0x123"), std::string::npos) << says("id");
  EXPECT_NE(says("id").find("0x6ff"), std::string::npos) << says("id");
  EXPECT_EQ(says("warnings"), "");
}

// Turning shafts: sigrok's rotary decoder counts what the image's timer has counted, up and down; the plain counts say the same.
TEST_F(ImageWaves, TheEncoderLinesCountWhatTheTimerCounts) {
  if (!has_sigrok()) GTEST_SKIP() << "sigrok-cli is not installed";
  ObservedImage run;
  WaveTrace trace({.last_s = 0.0, .filter = "wheel0,wheel1", .levels_only = true});
  trace.begins(*run.firmware, run.elf, 0);
  double theta_rad = 0.0;
  run.turn_ms(20, 3.0, theta_rad);
  const std::int64_t up = run.firmware->board(0).world().encoder_counts(0, 20'000'000);
  run.turn_ms(10, -2.0, theta_rad);
  trace.ends(*run.firmware);
  const ReadBack back = read_back(trace.text());
  const std::vector<std::string> counted =
      sigrok_says(written(trace.text()), "-P graycode:d0=wheel0_A:d1=wheel0_B");
  std::int64_t highest = 0;  // of its lines those that are a number alone: the phase, and the count
  for (const std::string& said : counted)
    if (std::ranges::all_of(said, [](unsigned char c) { return std::isdigit(c) != 0; }))
      highest = std::max<std::int64_t>(highest, std::stoll(said));
  EXPECT_EQ(highest, up);
  EXPECT_NEAR(static_cast<double>(up), 3.0 * 0.02 * 4096 / (2.0 * M_PI), 1.0);
  // The edges of an even motion are evenly apart: 3 rad/s at 4096 counts are 511.3 us.
  const auto& a = back.of.at("wheel0_A");
  for (std::size_t i = 3; i < 15; ++i)
    EXPECT_NEAR(static_cast<double>(a[i].first - a[i - 1].first), 2.0 * 2.0 * M_PI / 4096 / 3.0 * 1e9, 100.0)
        << i;
}

class WaveProgram : public ImageProgram {};

// The last stretch of a failed scenario: what the bridge was told is what its pin does.
TEST_F(WaveProgram, AFailedScenarioLeavesTheLastStretchAsSignals) {
  std::ofstream(folder_ / "fails.toml")
      << "format = \"omnihil-scenario/1\"\ntitle = \"fails\"\nduration_s = 0.3\n"
         "[[step]]\nat_s = 0.1\ndo = \"command\"\nv_forward_m_s = 1.0\n"
         "[[check]]\nis = \"signal\"\nsignal = \"v_forward_m_s\"\nat_most_m_s = -1\n";
  const std::string failing = "scenario run --no-plots" + shell(folder_ / "fails.toml") + image() +
                              "--trace" + shell(folder_ / "t.vcd") + "--trace-last 0.01 ";
  const Ran ran = run_omnihil(failing);
  EXPECT_EQ(ran.exit_code, 1) << ran.text;
  const ReadBack back = read_back(text_of(folder_ / "t.vcd"));
  EXPECT_TRUE(back.in_order);
  EXPECT_NEAR(static_cast<double>(back.last_ns), 300e6, 1e5);
  EXPECT_EQ(back.last_ns - back.first_ns, 10'000'000);
  for (const char* name : {"wheel0_duty", "wheel0_counts", "wheel3_A", "PE0_wheel0_direction", "TIM1_CH1",
                           "IRQ54", "PC6_robot_id0"})
    EXPECT_TRUE(back.of.contains(name)) << name;
  const double duty = std::stod(back.of.at("wheel0_duty").back().second);
  EXPECT_GT(std::abs(duty), 0.05);
  if (!has_sigrok()) GTEST_SKIP() << "sigrok-cli is not installed";
  EXPECT_EQ(run_omnihil(failing + "--trace-levels --trace-filter TIM1").exit_code, 1);
  const std::vector<std::string> said = sigrok_says(folder_ / "t.vcd", "-P pwm:data=TIM1_CH1");
  // Every duty that was held for a control period is one that the decoder has measured.
  const auto& duties = back.of.at("wheel0_duty");
  ASSERT_GT(duties.size(), 5u);
  for (std::size_t i = 1; i + 1 < duties.size(); ++i) {
    const double held = 100.0 * std::abs(std::stod(duties[i].second));
    EXPECT_TRUE(std::ranges::any_of(said, [held](const std::string& line) {
      return line.ends_with('%') && std::abs(std::stod(line) - held) < 0.01;
    })) << held;
  }
}

TEST_F(WaveProgram, ServeWritesTracesOfBothKindsAtItsEnd) {
  const std::string serve =
      "serve --clock free --duration 0.2 --robots 2,3 --physics planar --quiet --device" +
      shell(folder_ / "dongle") + image();
  const Ran vcd = run_omnihil(serve + "--trace" + shell(folder_ / "s.vcd") +
                              "--trace-last 0.05 --trace-filter IRQ54,duty");
  EXPECT_EQ(vcd.exit_code, 0) << vcd.text;
  const ReadBack back = read_back(text_of(folder_ / "s.vcd"));
  EXPECT_EQ(back.last_ns - back.first_ns, 50'000'000);
  EXPECT_TRUE(back.of.contains("robot2_IRQ54") && back.of.contains("robot3_IRQ54") &&
              back.of.contains("robot3_wheel1_duty"));
  EXPECT_FALSE(back.of.contains("robot2_wheel0_counts"));
  const Ran json = run_omnihil(serve + "--trace" + shell(folder_ / "s.json"));
  EXPECT_EQ(json.exit_code, 0) << json.text;
  EXPECT_NE(text_of(folder_ / "s.json").find("\"name\":\"robot 3\""), std::string::npos);
  EXPECT_EQ(run_omnihil(serve + "--trace" + shell(folder_ / "s.txt")).exit_code, 2);
}

}  // namespace
}  // namespace omnihil
