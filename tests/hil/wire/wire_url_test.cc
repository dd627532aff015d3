// Names of wires: what is read from them, the spellings of before, and what is said of wrong ones.
#include "hil/wire/wire_url.h"

#include <gtest/gtest.h>

#include <set>

#include "hil/wire/open_wire.h"

namespace omnihil {
namespace {

using Words = std::vector<std::string>;

Words texts_of(const std::vector<WireUrl>& urls) {
  Words texts;
  for (const WireUrl& url : urls) texts.push_back(url.text());
  return texts;
}

std::string only_problem(const std::string& text, WireForm form = WireForm::kEither) {
  const Words problems = wire_problems(read_wire_url(text), form);
  return problems.size() == 1 ? problems[0] : std::to_string(problems.size()) + " problems";
}

bool says(const std::string& text, const std::string& words) { return text.find(words) != std::string::npos; }

TEST(WireUrlTest, SchemeAddressAndParametersArePartedAndJoined) {
  const WireUrl url = read_wire_url("serial:/dev/ttyACM0?baud=9600&parity=even");
  EXPECT_EQ(url.scheme, "serial");
  EXPECT_EQ(url.address, "/dev/ttyACM0");
  EXPECT_EQ(url.query, (WireQuery{{"baud", "9600"}, {"parity", "even"}}));
  EXPECT_EQ(url.number("baud"), 9600);
  EXPECT_EQ(url.find("fd"), nullptr);
  EXPECT_EQ(url.text(), "serial:/dev/ttyACM0?baud=9600&parity=even");
}

TEST(WireUrlTest, AnAddressMayHaveColons) {
  EXPECT_EQ(read_wire_url("tcp:[::1]:5000").address, "[::1]:5000");
}

TEST(WireUrlTest, ABarePathIsAPathWhateverStandsInIt) {
  for (const std::string path :
       {"./dongle", "dongle", "/dev/serial/by-path/pci-0000:00:14.0-usb", "./a?b=c", "../x:y"}) {
    const WireUrl url = read_wire_url(path, "pty");
    EXPECT_EQ(url.scheme, "pty") << path;
    EXPECT_EQ(url.address, path);
    EXPECT_TRUE(url.query.empty()) << path;
    EXPECT_FALSE(looks_like_wire(path)) << path;
  }
  EXPECT_TRUE(looks_like_wire("serail:/dev/ttyACM0"));
}

TEST(WireUrlTest, SerialWithABaudRateBehindACommaIsTheOldSpelling) {
  EXPECT_EQ(read_wire_url("serial:/dev/ttyUSB0,921600").text(), "serial:/dev/ttyUSB0?baud=921600");
}

TEST(WireUrlTest, CanfdIsTheOldSpellingOfCanWithFd) {
  EXPECT_EQ(read_wire_url("canfd:can0").text(), "can:can0?fd=1");
  EXPECT_EQ(only_problem("canfd:can0"), "0 problems");
}

TEST(WireUrlTest, UartIsTheOldSpellingOfAPtyPerMotor) {
  EXPECT_EQ(texts_of(read_motor_wires("uart:./motor", 4)),
            (Words{"pty:./motor0", "pty:./motor1", "pty:./motor2", "pty:./motor3"}));
}

TEST(WireUrlTest, AListOfSerialPortsIsTheOldSpellingOfAPortPerMotor) {
  EXPECT_EQ(texts_of(read_motor_wires("serial:/dev/a,/dev/b", 4)), (Words{"serial:/dev/a", "serial:/dev/b"}));
}

TEST(WireUrlTest, MotorsAreFilledIn) {
  EXPECT_EQ(texts_of(read_motor_wires("serial:/dev/m{motor}?baud=9600", 2)),
            (Words{"serial:/dev/m0?baud=9600", "serial:/dev/m1?baud=9600"}));
  EXPECT_TRUE(read_motor_wires("pty:./motor", 4).empty());
  EXPECT_EQ(with_number("can:can{id}", "{id}", 12), "can:can12");
}

TEST(WireProblemsTest, AMisspeltSchemeIsAskedAfter) {
  EXPECT_TRUE(says(only_problem("serail:/dev/ttyACM0"), "\"serail\" is no wire, did you mean serial?"));
  const std::string far = only_problem("bluetooth:x");
  EXPECT_FALSE(says(far, "did you mean")) << far;
  EXPECT_TRUE(says(far, "can:, fdcanusb:, pty:, serial:, slcan:, tcp:, udp:")) << far;
  EXPECT_TRUE(says(only_problem("vcan0"), "\"vcan0\" names no wire")) << only_problem("vcan0");
}

TEST(WireProblemsTest, AMissingAddressIsNamedByItsKind) {
  EXPECT_TRUE(says(only_problem("serial:"), "no device; such as serial:/dev/ttyACM0"));
  EXPECT_TRUE(says(only_problem("can:"), "no interface; such as can:can0"));
}

TEST(WireProblemsTest, ParametersAreHeldToTheirKind) {
  EXPECT_TRUE(says(only_problem("serial:/dev/a?bauds=9600"), "did you mean baud?"));
  EXPECT_TRUE(says(only_problem("pty:./a?baud=9600"), "allowed: none"));
  EXPECT_TRUE(says(only_problem("serial:/dev/a?baud=12"), "baud rate \"12\"; allowed: 9600 to 12000000"));
  EXPECT_TRUE(says(only_problem("serial:/dev/a?baud=9600x"), "baud rate \"9600x\""));
  EXPECT_TRUE(says(only_problem("serial:/dev/a?parity=odd"), "parity \"odd\"; allowed: none, even"));
  EXPECT_TRUE(says(only_problem("serial:/dev/a?baud=9600&baud=9600"), "baud stands twice"));
  EXPECT_EQ(wire_problems(read_wire_url("serial:?baud=1&x=2"), WireForm::kBytes).size(), 3U);  // all at once
}

TEST(WireProblemsTest, AWireOfTheOtherFormIsRefusedWithThoseThatFit) {
  EXPECT_TRUE(
      says(only_problem("can:can0", WireForm::kBytes), "carries frames; needed: pty:, serial:, tcp:, udp:"));
  EXPECT_TRUE(
      says(only_problem("pty:./a", WireForm::kFrames), "carries bytes; needed: can:, fdcanusb:, slcan:"));
}

TEST(WireKindsTest, EveryKindSaysWhatItIsAndItsExampleIsTaken) {
  std::set<std::string_view> schemes;
  for (const WireKind* kind : wire_kinds()) {
    EXPECT_TRUE(schemes.insert(kind->scheme).second) << kind->scheme << " stands twice";
    EXPECT_FALSE(kind->says.empty()) << kind->scheme;
    EXPECT_EQ(kind->says.find('\n'), std::string_view::npos) << kind->scheme;
    EXPECT_NE(kind->open_bytes == nullptr, kind->open_frames == nullptr) << kind->scheme;
    const WireUrl example = read_wire_url(std::string(kind->example));
    EXPECT_EQ(example.scheme, kind->scheme);
    EXPECT_EQ(wire_problems(example, WireForm::kEither), Words{});
    for (const WireParameter& parameter : kind->parameters)
      EXPECT_TRUE(parameter.allows(parameter.usual)) << kind->scheme << " " << parameter.name;
  }
}

}  // namespace
}  // namespace omnihil
