// Faults of a radio format's file: each with line, key, value and what is allowed; all of them at once.
#include <algorithm>
#include <string>

#include "hil/radio_file/radio_file.h"
#include "tests/protocols/packet_util.h"

namespace omnihil {
namespace {

constexpr const char* kGood = R"(format = "omnihil-radio/1"
id = "x"
title = "X"
framing = "none"
[carrier]
kind = "uart"
baud = 9600
[[packet]]
name = "GO"
type = 1
direction = "to robot"
bit_order = "lsb first"
fields = [
  { name = "kind", bits = 8, kind = "type" },
  { name = "seen", bits = 1, kind = "integer" },
  { name = "speed", bits = 15, kind = "scaled", sign = "twos-complement", rule = "nearest", lo = -8, hi = 8,)"
                              R"( only_if = "seen", means = "v_forward_m_s" },
  { name = "sum", bits = 8, kind = "checksum", sum = "sum8", until = -1 },
]
)";

struct Fault {
  const char* good;
  const char* bad;
  int line;
  const char* says;     // key = value: what is wrong
  const char* allowed;  // or the nearest spelling
};

constexpr Fault kFaults[] = {
    {"omnihil-radio/1", "omnihil-radio/2", 1, "format = \"omnihil-radio/2\"", "omnihil-radio/1"},
    {"id = \"x\"\n", "", 1, "id: is missing", "a short name"},
    {"framing = \"none\"", "framing = \"slip\"", 4, "framing = \"slip\"", "\"none\", \"cobs\", \"list\""},
    {"framing = \"none\"", "framing = \"list\"", 1, "list: is missing", "begin, end and most"},
    {"baud = 9600", "baud = 9", 7, "carrier.baud = 9: is out of range", "50 to 100000000"},
    {"baud = 9600", "bauds = 9600", 7, "carrier.bauds: unknown key", "did you mean \"baud\"?"},
    {"kind = \"uart\"", "kind = \"udp\"", 7, "carrier.baud = 9600: is of no meaning here", "kind = \"uart\""},
    {"to robot", "to the robot", 11, "packet[0].direction", "\"to robot\", \"from robot\""},
    {"bit_order = \"lsb first\"\n", "", 8, "packet[0].bit_order: is missing", "\"lsb first\""},
    {"bits = 8, kind = \"type\"", "bits = 0, kind = \"type\"", 14,
     "packet[0].fields[0].bits = 0: is out of range", "1 to 64"},
    {"bits = 8, kind = \"type\"", "bits = 8, kind = \"typ\"", 14, "packet[0].fields[0].kind = \"typ\"",
     "\"type\""},
    {"bits = 1, kind = \"integer\"", "bits = 2, kind = \"integer\"", 13, "packet[0].fields", "7 bits more"},
    {"name = \"seen\"", "name = \"kind\"", 15, "is there twice", "a name of its own"},
    {"rule = \"nearest\"", "rule = \"neares\"", 16, "rule = \"neares\": is no rule of rounding",
     "did you mean \"nearest\"?"},
    {"hi = 8", "hi = -8", 16, "hi = -8: is not above lo", "more than -8"},
    {", hi = 8", "", 16, "packet[0].fields[2].hi: is missing", "a number"},
    {"only_if = \"seen\"", "only_if = \"sean\"", 16, "is no field before this one", "did you mean \"seen\"?"},
    {"means = \"v_forward_m_s\"", "means = \"v_forward\"", 16, "is nothing that a robot has",
     "v_forward_m_s"},
    {"means = \"v_forward_m_s\"", "times = 0.5", 16, "times = 0.5: is of no meaning here", "with means"},
    {"sum = \"sum8\"", "sum = \"sum9\"", 17, "sum = \"sum9\": is no sum that is known here", "sum8"},
    {"sum = \"sum8\"", "sum = \"crc32\"", 17, "bits = 8: does not go with this sum", "allowed: 32"},
    {"until = -1", "until = -9", 17, "is the sum of bytes 0 to -6 of 4", "inside the packet"},
    {"name = \"sum\", bits = 8, kind = \"checksum\", sum",
     "name = \"sum\", bits = 8, kind = \"integer\", sum", 17, "sum: unknown key", "allowed: name, bits"},
    {"title = \"X\"", "title = \"X\"\nrobots = \"rocos\"", 4, "robots = \"rocos\": is no built-in format",
     "rocos-serial-25"},
    {"title = \"X\"", "title = \"X\"\nrobots = \"rocos-serial-25\"", 4, "its packets are others: packet GO",
     "`means`"},
    {"type = 1\n", "type = \"1\"\n", 10, "packet[0].type", "a whole number"},
};

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), by);
}

TEST(RadioFileFaults, TheGoodFileHasNone) {
  const RadioFile file = read_radio_file(kGood, "x.toml");
  for (const ModelProblem& problem : file.problems) ADD_FAILURE() << problem.text();
  ASSERT_NE(file.format, nullptr);
  EXPECT_EQ(file.format->messages[0].size_bytes, 4);
}

TEST(RadioFileFaults, EachIsNamedWithLineKeyValueAndWhatIsAllowed) {
  for (const Fault& fault : kFaults) {
    const RadioFile file = read_radio_file(replaced(kGood, fault.good, fault.bad), "x.toml");
    EXPECT_EQ(file.format, nullptr) << fault.bad;
    std::string all;
    bool found = false;
    for (const ModelProblem& problem : file.problems) {
      all += problem.text() + "\n";
      const std::string text = problem.text();
      found = found ||
              (problem.line == fault.line && text.starts_with("x.toml:" + std::to_string(fault.line) + ":") &&
               text.find(fault.says) != std::string::npos && text.find(fault.allowed) != std::string::npos);
    }
    EXPECT_TRUE(found) << fault.good << " -> " << fault.bad << ": wanted line " << fault.line << " "
                       << fault.says << " … " << fault.allowed << "\n"
                       << all;
  }
}

TEST(RadioFileFaults, AreNamedAllAtOnceInTheOrderOfTheFile) {
  std::string text = kGood;
  text = replaced(text, "title = \"X\"", "titel = \"X\"");
  text = replaced(text, "kind = \"type\"", "kind = \"kind\"");
  text = replaced(text, "sum8", "sum7");
  const RadioFile file = read_radio_file(text, "x.toml");
  ASSERT_GE(file.problems.size(), 4u);
  for (std::size_t i = 1; i < file.problems.size(); ++i)
    EXPECT_LE(file.problems[i - 1].line, file.problems[i].line);
  EXPECT_EQ(file.problems.back().line, 17);
}

TEST(RadioFileFaults, TwoPacketsThatNothingTellsApartAreRefused) {
  std::string text = kGood;
  const std::string packet = text.substr(text.find("[[packet]]"));
  const RadioFile file = read_radio_file(text + replaced(packet, "\"GO\"", "\"STOP\""), "x.toml");
  ASSERT_EQ(file.problems.size(), 1u);
  EXPECT_NE(file.problems[0].text().find("cannot be told from packet GO"), std::string::npos);
}

TEST(RadioFileFaults, EachOfTwoFieldsWithoutANameIsNamed) {
  std::string text = replaced(kGood, "{ name = \"kind\",", "{");
  text = replaced(text, "{ name = \"sum\",", "{");
  const RadioFile file = read_radio_file(text, "x.toml");
  const auto of_names = std::count_if(file.problems.begin(), file.problems.end(), [](const ModelProblem& p) {
    return p.text().find("the field's name") != std::string::npos;
  });
  EXPECT_EQ(of_names, 2);
}

TEST(RadioFileFaults, NoFileAndNoTomlSaySo) {
  EXPECT_EQ(load_radio_file("/no/such/file.toml").problems.size(), 1u);
  const RadioFile file = read_radio_file("format = ", "x.toml");
  ASSERT_EQ(file.problems.size(), 1u);
  EXPECT_EQ(file.problems[0].line, 1);
}

}  // namespace
}  // namespace omnihil
