// Logs of other tools, written by Python from the formats' documents, come back with the numbers that went in.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "hil/logs/csv_log.h"
#include "hil/logs/log_table.h"
#include "hil/logs/ros_message.h"

namespace omnihil {
namespace {

namespace fs = std::filesystem;

const fs::path& logs() {
  static const fs::path folder = [] {
    const fs::path made =
        fs::temp_directory_path() / ("omnihil-logs-of-others-" + std::to_string(::getpid()));
    fs::remove_all(made);
    const std::string command =
        "/usr/bin/python3 '" OMNIHIL_SOURCE_DIR "/tests/hil/logs/make_logs.py' '" + made.string() + "'";
    EXPECT_EQ(std::system(command.c_str()), 0);
    return made;
  }();
  return folder;
}

LogTable read(const std::string& name) { return read_log((logs() / name).string(), {}); }

std::vector<double> truth(const std::string& column) {
  static const LogTable all = read("truth.csv");
  for (const LogSeries& s : all.series) {
    if (s.name == column) return s.value;
  }
  ADD_FAILURE() << column;
  return {};
}

const LogSeries& series(const LogTable& log, const std::string& name) {
  for (const LogSeries& s : log.series) {
    if (s.name == name) return s;
  }
  std::string names;
  for (const LogSeries& s : log.series) names += s.name + " ";
  ADD_FAILURE() << name << " is not among " << names;
  static const LogSeries none;
  return none;
}

void expect_same(const std::vector<double>& found, const std::vector<double>& expected, double relative,
                 double scale = 1.0) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i)
    ASSERT_NEAR(found[i] * scale, expected[i], relative * std::abs(expected[i]) + 1e-12) << i;
}

std::string notes(const LogTable& log) {
  std::string all;
  for (const std::string& note : log.notes) all += note + "\n";
  return all;
}

constexpr double kSingle = 1e-6;  // of numbers kept in four bytes

TEST(MatLog, VectorsAlsoInStructsOfVersions4To73) {
  if (!fs::exists(logs() / "run.mat")) GTEST_SKIP() << "scipy is not installed (python3-scipy)";
  const LogTable five = read("run.mat");
  EXPECT_EQ(five.format, LogFormat::kMat);
  expect_same(series(five, "time_s").value, truth("time_s"), 0.0);
  expect_same(series(five, "meas.current_A").value, truth("current"), 0.0);
  for (const char* word : {"note", "gain", "picture"})
    EXPECT_NE(notes(five).find(word), std::string::npos) << notes(five);
  expect_same(series(read("run4.mat"), "velocity_rad_s").value, truth("velocity"), 0.0);
  if (fs::exists(logs() / "run73.mat"))  // python3-h5py
    expect_same(series(read("run73.mat"), "velocity_rad_s").value, truth("velocity"), 0.0);
}

TEST(Wpilog, EntriesWithTheirOwnTimes) {
  const LogTable log = read("run.wpilog");
  EXPECT_EQ(log.format, LogFormat::kWpilog);
  EXPECT_FALSE(log.by_rows());
  const LogSeries& velocity = series(log, "/drive/velocity_rad_s");
  expect_same(velocity.value, truth("velocity"), kSingle);
  expect_same(*velocity.time_s, truth("time_s"), 1e-9);
  expect_same(series(log, "/drive/current_A").value, truth("current"), 0.0);
  EXPECT_EQ(series(log, "/drive/appliedVolts").value.size(),
            16u);  // logged where it changed, every 125 of 2000
  EXPECT_EQ(series(log, "/drive/pair[1]").value.front(), 2.0);
  EXPECT_EQ(series(log, "/drive/n").value.front(), -3.0);
  EXPECT_EQ(series(log, "/drive/ok").value.front(), 1.0);
  EXPECT_NE(notes(log).find("/who: 1 values of type string left out"), std::string::npos) << notes(log);
}

TEST(Ulog, MessagesWithNestedTypesListsAndPadding) {
  const LogTable log = read("run.ulg");
  EXPECT_EQ(log.format, LogFormat::kUlog);
  expect_same(series(log, "motor.velocity_rad_s").value, truth("velocity"), kSingle);
  expect_same(series(log, "motor.p.v[0]").value, truth("current"), kSingle);
  EXPECT_EQ(series(log, "motor.p.v[1]").value.front(), 2.0);
  EXPECT_EQ(series(log, "motor.n").value.front(), -5.0);
  EXPECT_EQ(series(log, "motor.ok").value.front(), 1.0);
  EXPECT_EQ(series(log, "battery.voltage_V").value.size(), 80u);
  EXPECT_NEAR(series(log, "battery.voltage_V").time_s->front(), 300e-6,
              1e-12);  // logged 300 us after the motor
  EXPECT_NE(notes(log).find("dropped data 1 times"), std::string::npos) << notes(log);
}

TEST(McapLog, CdrAndJsonPlainAndInPackedChunks) {
  for (const char* name : {"plain.mcap", "chunk.mcap", "zstd.mcap", "lz4.mcap"}) {
    if (!fs::exists(logs() / name)) continue;  // its Python module is not installed
    const LogTable log = read(name);
    expect_same(series(log, "/joint_states.velocity[wheel]").value, truth("velocity"), 0.0);
    EXPECT_EQ(series(log, "/joint_states.velocity[wheel]").unit, "rad/s");
    expect_same(*series(log, "/joint_states.velocity[wheel]").time_s, truth("time_s"), 1e-9);
    expect_same(series(log, "/drive.duty").value, truth("duty"), kSingle);
    expect_same(series(log, "/drive.phases[2]").value, truth("current"), 0.0);
    expect_same(series(log, "/drive.bus_voltage").value, truth("bus_V"), kSingle);
    EXPECT_EQ(series(log, "/drive.more[0].b").value.front(), 0.5);
    EXPECT_EQ(series(log, "/drive.step").value.front(), -2.0);
    EXPECT_EQ(series(log, "/json.temperature_C").value.front(), 40.5);
    EXPECT_EQ(series(log, "/json.more.x[1]").value.front(), 2.0);
    EXPECT_NE(notes(log).find("/other: 1 messages left out: encoding protobuf"), std::string::npos)
        << notes(log);
    EXPECT_NE(notes(log).find("2000 messages stand at the stamp of their header"), std::string::npos)
        << notes(log);
  }
}

TEST(RosbagLog, KnownTypesNeedNoDefinition) {
  const LogTable log = read("run.db3");
  EXPECT_EQ(log.format, LogFormat::kRosbag);
  expect_same(series(log, "/joint_states.velocity[wheel]").value, truth("velocity"), 0.0);
  expect_same(series(log, "/wheel/duty.data").value, truth("duty"), kSingle);
  EXPECT_NE(
      notes(log).find("/own: 2000 messages left out: type my_msgs/msg/Drive has no definition in the bag"),
      std::string::npos)
      << notes(log);
}

// Every reader, on every beginning of a file: it reads what is whole, or refuses; it never reads beyond.
TEST(BinaryLogs, FilesThatEndEarlyAreReadAsFarAsTheyGoOrRefused) {
  const fs::path cut = fs::temp_directory_path() / ("omnihil-cut-log-" + std::to_string(::getpid()));
  for (const char* name :
       {"run.wpilog", "run.ulg", "plain.mcap", "chunk.mcap", "zstd.mcap", "run.db3", "run.mat"}) {
    if (!fs::exists(logs() / name)) continue;
    std::ifstream in(logs() / name, std::ios::binary);
    const std::string whole((std::istreambuf_iterator<char>(in)), {});
    std::size_t read_some = 0, refused = 0;
    for (const double share : {0.0001, 0.001, 0.01, 0.1, 0.5, 0.77, 0.99}) {
      std::ofstream(cut, std::ios::binary)
          << whole.substr(0, static_cast<std::size_t>(share * static_cast<double>(whole.size())));
      try {
        read_some += !read_log(cut.string(), {}).series.empty();
      } catch (const BadLog& bad) {
        ++refused;
        EXPECT_NE(std::string(bad.what()).find(cut.string()), std::string::npos) << bad.what();
      } catch (const std::system_error&) {
        ++refused;  // nothing was left of it
      }
    }
    EXPECT_EQ(read_some + refused, 7u) << name;
    if (std::string(name) == "run.wpilog" || std::string(name) == "run.ulg" ||
        std::string(name) == "plain.mcap") {
      EXPECT_GE(read_some, 4u) << name;
    }
  }
  fs::remove(cut);
}

TEST(BinaryLogs, RandomBytesBehindAGoodHeadDoNoHarm) {
  const fs::path noise = fs::temp_directory_path() / ("omnihil-noise-log-" + std::to_string(::getpid()));
  std::uint32_t state = 1;
  for (const std::string& head :
       {std::string("WPILOG\0\x01\0\0\0\0", 12), std::string("ULog\x01\x12\x35\x01") + std::string(8, '\0'),
        std::string("\x89MCAP0\r\n")}) {
    for (int round = 0; round < 200; ++round) {
      std::string text = head;
      for (int i = 0; i < 300; ++i) {
        state = state * 1664525u + 1013904223u;
        text += static_cast<char>(round % 2 == 0 ? state >> 24 : (state >> 24) % 7);
      }
      std::ofstream(noise, std::ios::binary) << text;
      EXPECT_THROW(read_log(noise.string(), {}), BadLog);
    }
  }
  fs::remove(noise);
}

TEST(RosMessages, AnotherEncodingOrShortBytesAreRefused) {
  const RosType type("std_msgs/msg/Float64", common_ros_definition("std_msgs/msg/Float64"));
  const auto read_bytes = [&](std::string bytes) {
    RosNumbers numbers;
    return type.read(bytes, numbers);
  };
  EXPECT_TRUE(read_bytes(std::string("\0\1\0\0", 4) + std::string(8, '\0')));
  EXPECT_FALSE(read_bytes(std::string("\0\0\0\0", 4) + std::string(8, '\0')));  // big-endian
  EXPECT_FALSE(read_bytes(std::string("\0\1\0\0", 4) + std::string(7, '\0')));
  EXPECT_FALSE(read_bytes(""));
  EXPECT_EQ(common_ros_definition("my_msgs/msg/Own"), "");
}

}  // namespace
}  // namespace omnihil
