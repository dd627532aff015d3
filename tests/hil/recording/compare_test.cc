#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "hil/recording/compare_recordings.h"
#include "hil/recording/replay_run.h"
#include "tests/hil/recording/real_run.h"

namespace omnihil {
namespace {

using Kind = RecordedChunk::Kind;

const Recording& hermes() {
  static const Recording recording = real::record(real::setup(real::kHermes), 120);
  return recording;
}
const Recording& rem() {
  static const Recording recording = real::record(real::setup(real::kRem), 120);
  return recording;
}

Tolerances exact() {
  Tolerances tolerances;
  tolerances.exact = true;
  return tolerances;
}

RecordingComparison compare(const Recording& a, const Recording& b, const Tolerances& tolerances = {}) {
  return compare_recordings(a, b, *find_radio_format(a.header.radio_format), tolerances);
}

std::size_t column(const Recording& recording, const std::string& name) {
  const auto& columns = recording.header.columns;
  const auto at = std::find(columns.begin(), columns.end(), name);
  EXPECT_NE(at, columns.end()) << name;
  return static_cast<std::size_t>(at - columns.begin());
}

// The nth chunk of a kind.
RecordedChunk& nth(Recording& recording, Kind kind, int n) {
  for (RecordedChunk& chunk : recording.chunks) {
    if (chunk.kind == kind && n-- == 0) return chunk;
  }
  throw std::out_of_range("no such chunk");
}

TEST(Compare, RunAgreesWithItselfInEveryBit) {
  for (const Recording* recording : {&hermes(), &rem()}) {
    const RecordingComparison result = compare(*recording, *recording, exact());
    EXPECT_TRUE(result.agrees());
    EXPECT_TRUE(result.bytes_identical);
    EXPECT_TRUE(result.samples_identical);
    EXPECT_GT(result.packets, 0U);
    const std::uint64_t sample_values = result.samples * sample_columns().size();
    EXPECT_GT(result.values(), sample_values);
    for (const SignalSummary& signal : result.signals) EXPECT_EQ(signal.largest, 0.0) << signal.name;
  }
}

TEST(Compare, OneBitOfOneValueIsFoundAndNamed) {
  for (const SampleColumn& which : sample_columns()) {
    Recording planted = hermes();
    RecordedChunk& chunk = nth(planted, Kind::kSample, 9);
    double& value = chunk.sample[column(planted, which.name)];
    const double before = value;
    value = std::nextafter(value, 1e9);
    const RecordingComparison result = compare(planted, hermes(), exact());
    ASSERT_FALSE(result.agrees()) << which.name;
    EXPECT_EQ(result.first->what, which.name);
    EXPECT_EQ(result.first->now_ns, chunk.now_ns);
    EXPECT_EQ(result.first->robot_id, chunk.robot_id);
    double recorded = 0.0, replayed = 0.0;
    ASSERT_TRUE(parse_number(result.first->recorded, recorded) &&
                parse_number(result.first->replayed, replayed));
    EXPECT_EQ(recorded, value);
    EXPECT_EQ(replayed, before);
  }
}

TEST(Compare, DifferenceBeyondToleranceIsFoundAndWithinItIsNot) {
  Recording planted = hermes();
  nth(planted, Kind::kSample, 9).sample[column(planted, "true_v_left_m_s")] += 0.0049;
  EXPECT_TRUE(compare(planted, hermes()).agrees());
  nth(planted, Kind::kSample, 9).sample[column(planted, "true_v_left_m_s")] += 0.0002;
  const RecordingComparison result = compare(planted, hermes());
  ASSERT_FALSE(result.agrees());
  EXPECT_EQ(result.first->what, "true_v_left_m_s");
  EXPECT_EQ(result.first->unit, "m/s");
  EXPECT_EQ(result.first->tolerance, 0.005);
  const std::string text = result.first->text();
  EXPECT_NE(text.find("robot "), std::string::npos) << text;
  EXPECT_NE(text.find("true_v_left_m_s: recorded "), std::string::npos) << text;
  EXPECT_NE(text.find("m/s (tolerance 0.005)"), std::string::npos) << text;
}

TEST(Compare, EveryBitOfTheDonglesBytesIsSeen) {
  for (std::size_t bit = 0; bit < 64; ++bit) {
    Recording planted = hermes();
    RecordedChunk& chunk = nth(planted, Kind::kDongleBytes, 1);
    ASSERT_EQ(chunk.bytes.size(), 8U);  // BATTERIE_RESPONSE: six bytes in COBS, and the delimiter
    chunk.bytes[bit / 8] = static_cast<std::uint8_t>(chunk.bytes[bit / 8] ^ (1U << (bit % 8)));
    for (const Tolerances& tolerances : {exact(), Tolerances{}}) {
      const RecordingComparison result = compare(planted, hermes(), tolerances);
      ASSERT_FALSE(result.agrees()) << "bit " << bit;
      EXPECT_FALSE(result.bytes_identical);
      EXPECT_EQ(result.first->now_ns, chunk.now_ns) << "bit " << bit;
    }
  }
}

// The chunk that holds one BATTERIE_RESPONSE, with another voltage and a right checksum.
void plant_voltage(RecordedChunk& chunk, double by_decivolts) {
  const RadioFormat& format = *find_radio_format("ulaval-hermes");
  Values values = format.decode(chunk.bytes).values;
  ASSERT_EQ(values.message->name, "BATTERIE_RESPONSE");
  values.set("decivolts", values.number("decivolts") + by_decivolts);
  values.fields[static_cast<std::size_t>(values.message->field_index("checksum"))] = {};
  chunk.bytes.clear();
  ASSERT_EQ(format.encode(values, chunk.bytes).error, PacketError::kNone);
}

TEST(Compare, PacketFieldIsNamedWithRobotAndBothValues) {
  Recording planted = hermes();
  RecordedChunk& chunk = nth(planted, Kind::kDongleBytes, 1);
  const double before = find_radio_format("ulaval-hermes")->decode(chunk.bytes).values.number("decivolts");
  const double robot = find_radio_format("ulaval-hermes")->decode(chunk.bytes).values.number("robot");
  plant_voltage(chunk, 3);
  const RecordingComparison result = compare(planted, hermes());
  ASSERT_FALSE(result.agrees());
  EXPECT_EQ(result.first->what, "packet BATTERIE_RESPONSE field decivolts");
  EXPECT_EQ(result.first->robot_id, static_cast<int>(robot));
  EXPECT_EQ(result.first->recorded, std::to_string(static_cast<int>(before) + 3));
  EXPECT_EQ(result.first->replayed, std::to_string(static_cast<int>(before)));
}

TEST(Compare, PacketFieldMayDifferByOneStepOfItsResolution) {
  Recording planted = hermes();
  plant_voltage(nth(planted, Kind::kDongleBytes, 1), 1);
  EXPECT_TRUE(compare(planted, hermes()).agrees());
  EXPECT_FALSE(compare(planted, hermes(), exact()).agrees());
}

TEST(Compare, MissingPacketAndPacketTooManyAreNamed) {
  Recording fewer = hermes();
  const std::int64_t at_ns = nth(fewer, Kind::kDongleBytes, 2).now_ns;
  std::erase_if(fewer.chunks,
                [&](const RecordedChunk& c) { return c.kind == Kind::kDongleBytes && c.now_ns >= at_ns; });
  const RecordingComparison more = compare(fewer, hermes());
  ASSERT_FALSE(more.agrees());
  EXPECT_EQ(more.first->what, "packet");
  EXPECT_EQ(more.first->recorded, "none");
  EXPECT_EQ(more.first->now_ns, at_ns);
  const RecordingComparison less = compare(hermes(), fewer);
  ASSERT_FALSE(less.agrees());
  EXPECT_EQ(less.first->replayed, "none");
}

TEST(Compare, LatePacketIsNamed) {
  Recording late = hermes();
  nth(late, Kind::kDongleBytes, 1).now_ns += 2'000'000;
  const RecordingComparison result = compare(late, hermes());
  ASSERT_FALSE(result.agrees());
  EXPECT_EQ(result.first->what, "time of packet BATTERIE_RESPONSE");
  Tolerances loose;
  loose.settings["packet_time_s"] = 0.0021;
  EXPECT_TRUE(compare(late, hermes(), loose).agrees());
}

TEST(Compare, MissingSampleIsNamed) {
  Recording fewer = hermes();
  fewer.chunks.erase(std::find_if(fewer.chunks.begin(), fewer.chunks.end(), [](const RecordedChunk& c) {
    return c.kind == Kind::kSample && c.robot_id == 3;
  }));
  const RecordingComparison result = compare(fewer, hermes());
  ASSERT_FALSE(result.agrees());
  EXPECT_EQ(result.first->what, "sample");
}

TEST(Compare, TheEarliestDifferenceIsNamedFirst) {
  Recording planted = hermes();
  nth(planted, Kind::kSample, 40).sample[column(planted, "true_x_m")] += 1.0;
  nth(planted, Kind::kSample, 30).sample[column(planted, "true_y_m")] += 1.0;
  EXPECT_EQ(compare(planted, hermes()).first->what, "true_y_m");
}

TEST(Compare, AnglesAreComparedTheShortWayRound) {
  Recording turned = hermes();
  nth(turned, Kind::kSample, 4).sample[column(turned, "true_yaw_rad")] += 2.0 * std::numbers::pi;
  EXPECT_TRUE(compare(turned, hermes()).agrees());
  nth(turned, Kind::kSample, 4).sample[column(turned, "true_yaw_rad")] += 0.1;
  EXPECT_FALSE(compare(turned, hermes()).agrees());
}

TEST(Compare, SummaryHasTheLargestDifferenceOfEachSignal) {
  Recording planted = hermes();
  RecordedChunk& chunk = nth(planted, Kind::kSample, 12);
  chunk.sample[column(planted, "true_load_N_3")] += 0.5;
  const RecordingComparison result = compare(planted, hermes());
  const auto at = std::find_if(result.signals.begin(), result.signals.end(),
                               [](const SignalSummary& s) { return s.name == "true_load_N"; });
  ASSERT_NE(at, result.signals.end());
  EXPECT_NEAR(at->largest, 0.5, 1e-12);
  EXPECT_EQ(at->largest_ns, chunk.now_ns);
  EXPECT_EQ(at->largest_robot, chunk.robot_id);
  EXPECT_EQ(at->beyond, 1U);
  EXPECT_EQ(at->values, 4U * result.samples);
}

TEST(Compare, ColumnsOfOtherVersionsAreListedAndLeftOut) {
  Recording old = hermes();
  old.header.columns[0] = "duty_of_old";
  const RecordingComparison result = compare(old, hermes(), exact());
  EXPECT_TRUE(result.agrees());
  EXPECT_EQ(result.not_compared, std::vector<std::string>{"duty_of_old"});
}

TEST(Compare, OnePercentOfTheMotorsTorqueConstantIsSeen) {
  Recording recorded = real::record(real::setup(real::kHermes), 400);
  std::string& model = recorded.header.robot_model_text;
  const std::string key = "torque_constant_Nm_per_A = { value = 0.0255,";
  const std::size_t at = model.find(key);
  ASSERT_NE(at, std::string::npos);
  model.replace(at, key.size(), "torque_constant_Nm_per_A = { value = 0.02525,");
  EXPECT_FALSE(compare(recorded, run_again(recorded, {}).answer).agrees());
}

TEST(Compare, PhysicsOfTheClosedFormAgreesWithSimbody) {
  const Recording recorded = real::record(real::setup(real::kHermesSimbody), 200);
  const ReplayRun planar = run_again(recorded, {.physics = Physics::kPlanar, .observer = nullptr});
  const RecordingComparison result = compare(recorded, planar.answer);
  EXPECT_TRUE(result.agrees()) << result.first->text();
}

TEST(Tolerances, MostParticularSettingHolds) {
  Tolerances tolerances;
  EXPECT_EQ(tolerances.of_column("true_load_N_2", "N"), 0.1);
  tolerances.settings["unit:N"] = 1.0;
  EXPECT_EQ(tolerances.of_column("true_load_N_2", "N"), 1.0);
  tolerances.settings["true_load_N"] = 2.0;
  EXPECT_EQ(tolerances.of_column("true_load_N_2", "N"), 2.0);
  tolerances.settings["true_load_N_2"] = 3.0;
  EXPECT_EQ(tolerances.of_column("true_load_N_2", "N"), 3.0);
  EXPECT_EQ(tolerances.of_column("true_load_N_1", "N"), 2.0);
  tolerances.exact = true;
  EXPECT_EQ(tolerances.of_column("true_load_N_2", "N"), 0.0);
}

TEST(Tolerances, FileIsReadAndEveryFaultIsNamed) {
  Tolerances tolerances;
  std::vector<std::string> problems;
  const RadioFormat* format = find_radio_format("ulaval-hermes");
  tolerances.read_file("# comment\nunit:m = 0.5   # half a metre\n\nBATTERIE_RESPONSE.decivolts=2\n", "t",
                       format, problems);
  EXPECT_TRUE(problems.empty()) << problems[0];
  EXPECT_EQ(tolerances.of_column("true_x_m", "m"), 0.5);
  EXPECT_EQ(tolerances.settings.at("BATTERIE_RESPONSE.decivolts"), 2.0);
  tolerances.read_file("true_x_n = 1\nunit:m\nunit:m = -1\nunit:m = wide\nunit:m = nan", "t", format,
                       problems);
  ASSERT_EQ(problems.size(), 5U);
  EXPECT_NE(problems[0].find("t:1"), std::string::npos) << problems[0];
  EXPECT_NE(problems[0].find("did you mean 'true_x_m'"), std::string::npos) << problems[0];
  EXPECT_NE(problems[1].find("KEY=VALUE"), std::string::npos) << problems[1];
  EXPECT_NE(problems[2].find("'-1'"), std::string::npos) << problems[2];
  EXPECT_NE(problems[3].find("'wide'"), std::string::npos) << problems[3];
  EXPECT_NE(problems[4].find("t:5"), std::string::npos) << problems[4];
}

TEST(Tolerances, EveryColumnsUnitHasADefault) {
  for (const SampleColumn& each : sample_columns()) {
    EXPECT_GT(Tolerances{}.of_column(each.name, each.unit), 0.0) << each.name << " in " << each.unit;
  }
}

}  // namespace
}  // namespace omnihil
