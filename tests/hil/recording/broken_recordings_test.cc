// Recordings that are broken in one way each: refused with file, line, what was found and what is allowed.
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "hil/recording/recording_header.h"
#include "hil/recording/recording_reader.h"
#include "tests/hil/recording/fake_run.h"

namespace omnihil {
namespace {

// A sound recording, line by line: header, three chunks, a close, a sample, the end.
std::vector<std::string> sound() {
  RecordingHeader header = fake::header({0, 3});
  header.columns = {"true_x_m", "true_y_m"};
  header.units = {"m", "m"};
  return {"# " + to_json(header), "> 0 03ff00",
          "< 1000000 80017f00",   "s 2000000 3 0.25 -0.5",
          "! 3000000 closed",     R"(# {"end":{"now_ns":4000000,"wall_s":0.5,"counters":{"good":1}}})"};
}

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

Recording load(const std::string& text) {
  std::istringstream stream(text);
  return load_recording(stream, "run.omnirec");
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

struct Broken {
  const char* name;
  std::size_t line;      // index of the line that is replaced
  std::string from, to;  // within it; empty `from`: the whole line
  std::string place;     // the message must have these three
  std::string found;
  std::string allowed;
};
void PrintTo(const Broken& c, std::ostream* out) { *out << c.name; }

const Broken kBroken[] = {
    {"NotAHeader", 0, "# {", "{", "run.omnirec:1: header", "{\"format\"", "'# {…}'"},
    {"HeaderIsNotJson", 0, "\"format\":", "format:", "run.omnirec:1: header", "format", "JSON object"},
    {"OtherFormat", 0, "omnihil-recording/1", "omnihil-recording/9", "run.omnirec:1: header: key 'format'",
     "omnihil-recording/9", "omnihil-recording/1"},
    {"UnknownHeaderKey", 0, "\"seed\"", "\"sede\":1,\"seed\"", "key 'sede'", "1", "no such key"},
    {"MissingHeaderKey", 0, "\"radio\":\"ulaval-hermes\",", "", "key 'radio'", "nothing", "a text"},
    {"UnknownTeam", 0, "\"yellow\"", "\"green\"", "key 'team'", "green", "yellow, blue"},
    {"UnknownPhysics", 0, "\"planar\"", "\"bullet\"", "key 'physics'", "bullet",
     "simbody, simbody-free, planar"},
    {"StepOfZero", 0, "\"step_ns\":1000000", "\"step_ns\":0", "key 'step_ns'", "0", "from 1"},
    {"NegativeSeed", 0, "\"seed\":18446744073709551615", "\"seed\":-1", "key 'seed'", "-1", ">= 0"},
    {"IdsNotAscending", 0, "[0,3]", "[3,0]", "key 'robot_ids'", "0", "ascending"},
    {"NoRobots", 0, "[0,3]", "[]", "key 'robot_ids'", "[]", "at least one"},
    {"FewerUnitsThanColumns", 0, "[\"m\",\"m\"]", "[\"m\"]", "key 'units'", "1 units", "2"},
    {"ColumnTwice", 0, "\"true_y_m\"", "\"true_x_m\"", "key 'columns'", "twice", "each name once"},
    {"UnknownTag", 1, ">", "]", "run.omnirec:2: line tag", "']'",
     "'>', '<', '}', '!', 's', 't', 'c', 'p', 'v', 'a', 'b', 'w', 'm', '#'"},
    {"PlacedWithTooFew", 3, "", "p 2000000 3 1.5 2.5", "run.omnirec:4: values", "fewer", "3"},
    {"PlacedWithTooMany", 3, "", "p 2000000 3 1.5 2.5 0 7", "run.omnirec:4: values", "more", "3"},
    {"CommandOfWords", 3, "", "c 2000000 3 1 forward", "run.omnirec:4: value 2", "'forward'",
     "a finite number"},
    {"CommandToNobody", 3, "", "c 2000000 4 1", "run.omnirec:4: robot id", "'4'", "0, 3"},
    {"ConsoleOfNobody", 3, "", "t 2000000 4 0 USART2 boot", "run.omnirec:4: robot id", "'4'", "0, 3"},
    {"ConsoleOfNoBoard", 3, "", "t 2000000 3 16 USART2 boot", "run.omnirec:4: board", "'16'", "0 to 15"},
    {"ConsoleWithoutPort", 3, "", "t 2000000 3 0", "run.omnirec:4: port", "nothing", "USART2"},
    {"EmptyLine", 1, "", "", "run.omnirec:2: line tag", "''", "'>'"},
    {"OddHexDigits", 1, "03ff00", "03ff0", "run.omnirec:2: bytes", "'03ff0'", "pairs of hex digits"},
    {"NotHex", 1, "03ff00", "03fg00", "run.omnirec:2: bytes", "'03fg00'", "pairs of hex digits"},
    {"NoBytes", 1, " 03ff00", "", "run.omnirec:2: bytes", "''", "at least one"},
    {"WindowsLineEnd", 1, "03ff00", "03ff00\r", "run.omnirec:2: bytes", "'03ff00.'", "hex"},
    {"TimeGoesBackwards", 3, "2000000", "999999", "run.omnirec:4: time", "'999999'", "1000000 or later"},
    {"NegativeTime", 1, "> 0", "> -1", "run.omnirec:2: time", "'-1'", "0 or more"},
    {"TimeIsNotWhole", 2, "1000000", "1e6", "run.omnirec:3: time", "'1e6'", "whole nanoseconds"},
    {"TimeTooLarge", 2, "1000000", "99999999999999999999", "run.omnirec:3: time", "9999",
     "whole nanoseconds"},
    {"RobotThatIsNotThere", 3, " 3 ", " 2 ", "run.omnirec:4: robot id", "'2'", "0, 3"},
    {"TooFewValues", 3, " -0.5", "", "run.omnirec:4: sample", "1 values", "2"},
    {"TooManyValues", 3, "-0.5", "-0.5 7", "run.omnirec:4: sample", "3 values", "2"},
    {"ValueIsNotANumber", 3, "-0.5", "half", "run.omnirec:4: column 'true_y_m'", "'half'", "finite"},
    {"ValueIsInfinite", 3, "-0.5", "inf", "run.omnirec:4: column 'true_y_m'", "'inf'", "finite"},
    {"ValueIsNan", 3, "0.25", "nan", "run.omnirec:4: column 'true_x_m'", "'nan'", "finite"},
    {"TwoBlanks", 3, "0.25 -0.5", "0.25  -0.5", "run.omnirec:4: sample", "3 values", "2"},
    {"UnknownEvent", 4, "closed", "opened", "run.omnirec:5: event", "'opened'", "'closed'"},
    {"EndBeforeLastChunk", 5, "4000000", "1", "run.omnirec:6: end", "1", "3000000 or later"},
    {"EndWithoutTime", 5, "now_ns", "now", "run.omnirec:6: end line", "now", "now_ns"},
    {"EndTimeIsNotWhole", 5, "4000000", "4e300", "run.omnirec:6: end line", "4e300", "now_ns"},
    {"EndCounterIsNegative", 5, "\"good\":1", "\"good\":-1", "run.omnirec:6: end line", "end", "counters"},
    {"LineAfterTheEnd", 4, "! 3000000 closed", R"(# {"end":{"now_ns":3000000,"wall_s":0,"counters":{}}})",
     "run.omnirec:6: after the end line", "end", "nothing"},
};

class BrokenRecording : public testing::TestWithParam<Broken> {};

TEST_P(BrokenRecording, IsRefusedWithPlaceFoundAndAllowed) {
  const Broken& broken = GetParam();
  std::vector<std::string> lines = sound();
  std::string& line = lines[broken.line];
  line = broken.from.empty() ? broken.to : replaced(line, broken.from, broken.to);
  try {
    load(joined(lines));
    FAIL() << "was taken";
  } catch (const BadRecording& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find(broken.place), std::string::npos) << text;
    EXPECT_NE(text.find("found"), std::string::npos) << text;
    EXPECT_NE(text.find(broken.found), std::string::npos) << text;
    EXPECT_NE(text.find("allowed"), std::string::npos) << text;
    EXPECT_NE(text.find(broken.allowed), std::string::npos) << text;
  }
}

INSTANTIATE_TEST_SUITE_P(Corpus, BrokenRecording, testing::ValuesIn(kBroken),
                         [](const auto& each) { return std::string(each.param.name); });

TEST(RecordingReader, TakesTheSoundOne) {
  const Recording recording = load(joined(sound()));
  EXPECT_EQ(recording.chunks.size(), 4U);
  EXPECT_TRUE(recording.complete);
  EXPECT_FALSE(recording.last_line_cut);
}

TEST(RecordingReader, CollectsAllProblems) {
  std::vector<std::string> lines = sound();
  lines[1] = "> 0 zz";
  lines[2] = "? 1 00";
  lines[3] = "s 2000000 3 0.25";
  try {
    load(joined(lines));
    FAIL() << "was taken";
  } catch (const BadRecording& error) {
    ASSERT_EQ(error.problems().size(), 3U) << error.what();
    EXPECT_EQ(error.problems()[0].substr(0, 14), "run.omnirec:2:");
    EXPECT_EQ(error.problems()[1].substr(0, 14), "run.omnirec:3:");
    EXPECT_EQ(error.problems()[2].substr(0, 14), "run.omnirec:4:");
  }
}

TEST(RecordingReader, StopsListingAfterTwentyProblems) {
  std::string text = sound()[0] + "\n";
  for (int i = 0; i < 1000; ++i) text += "nonsense\n";
  try {
    load(text);
    FAIL() << "was taken";
  } catch (const BadRecording& error) {
    EXPECT_EQ(error.problems().size(), RecordingReader::kMaxProblems);
  }
}

TEST(RecordingReader, TakesARunCutAtAnyByteAfterTheHeader) {
  const std::string whole = joined(sound());
  const std::size_t header_end = whole.find('\n') + 1;
  for (std::size_t cut = header_end; cut < whole.size(); ++cut) {
    const Recording recording = load(whole.substr(0, cut));
    const auto lines =
        static_cast<std::size_t>(std::count(whole.begin(), whole.begin() + static_cast<long>(cut), '\n'));
    EXPECT_EQ(recording.chunks.size(), std::min<std::size_t>(lines - 1, 4)) << "cut at " << cut;
    EXPECT_EQ(recording.last_line_cut, whole[cut - 1] != '\n') << "cut at " << cut;
    EXPECT_FALSE(recording.complete) << "cut at " << cut;
  }
}

// Whatever one byte becomes, the file is taken or refused with a place; nothing else happens.
TEST(RecordingReader, AnyDamagedByteIsTakenOrRefusedWithItsPlace) {
  const std::string whole = joined(sound());
  int refused = 0;
  for (std::size_t at = 0; at < whole.size(); ++at) {
    for (const char other : {'\0', '\n', ' ', '"', '-', '9', 'e', '{', '}', ',', '\x80'}) {
      std::string damaged = whole;
      damaged[at] = other;
      try {
        load(damaged);
      } catch (const BadRecording& error) {
        ++refused;
        ASSERT_FALSE(error.problems().empty());
        for (const std::string& problem : error.problems())
          ASSERT_EQ(problem.rfind("run.omnirec:", 0), 0U) << problem;
      }
    }
  }
  EXPECT_GT(refused, static_cast<int>(whole.size()));
}

TEST(RecordingReader, RefusesARunCutInsideTheHeader) {
  const std::string header = sound()[0];
  for (std::size_t cut = 0; cut <= header.size(); cut += 7) {
    EXPECT_THROW(load(header.substr(0, cut)), BadRecording) << "cut at " << cut;
  }
}

TEST(RecordingReader, RefusesOtherFiles) {
  EXPECT_THROW(load(""), BadRecording);
  EXPECT_THROW(load("\n"), BadRecording);
  EXPECT_THROW(load(std::string(4096, '\0')), BadRecording);
  EXPECT_THROW(load("\x7f\x45\x4c\x46\x02\x01\n\xff\xfe\n"), BadRecording);
  EXPECT_THROW(load("# []\n"), BadRecording);
  EXPECT_THROW(load("# {}\n"), BadRecording);
}

TEST(RecordingReader, NamesTheFileThatCannotBeOpened) {
  try {
    load_recording(std::filesystem::path("/nonexistent/run.omnirec"));
    FAIL() << "was opened";
  } catch (const std::system_error& error) {
    EXPECT_EQ(error.code(), std::errc::no_such_file_or_directory);
    EXPECT_NE(std::string(error.what()).find("/nonexistent/run.omnirec"), std::string::npos);
  }
  EXPECT_THROW(load_recording(std::filesystem::path("/tmp")), std::system_error);
}

}  // namespace
}  // namespace omnihil
