#include "hil/recording/replay.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "hil/recording/compare_recordings.h"
#include "hil/recording/replay_hash.h"
#include "hil/recording/replay_run.h"
#include "tests/hil/recording/real_run.h"

namespace omnihil {
namespace {

class ReplayOf : public testing::TestWithParam<real::Case> {};

std::size_t count_of(const Recording& recording, RecordedChunk::Kind kind) {
  return static_cast<std::size_t>(
      std::count_if(recording.chunks.begin(), recording.chunks.end(),
                    [&](const RecordedChunk& chunk) { return chunk.kind == kind; }));
}

TEST_P(ReplayOf, RecordingGivesTheSameLinesBack) {
  const Recording recorded = real::record(real::setup(GetParam()), 150);
  EXPECT_GT(count_of(recorded, RecordedChunk::Kind::kDongleBytes), 0U);
  EXPECT_EQ(count_of(recorded, RecordedChunk::Kind::kHostClosed), 1U);
  EXPECT_EQ(count_of(recorded, RecordedChunk::Kind::kSample), 2U * 150U / 5U);
  const Recording read = real::from_text(real::text_of(recorded));
  const ReplayRun again = run_again(read, {});
  EXPECT_EQ(real::text_of(again.answer), real::text_of(recorded));
  EXPECT_FALSE(first_byte_difference(read, again.answer));
}

TEST_P(ReplayOf, RecordingHasOneHashHoweverOftenItIsRun) {
  const Recording recorded = real::record(real::setup(GetParam()), 40);
  std::set<std::string> hashes;
  for (int i = 0; i < 20; ++i) hashes.insert(run_again(recorded, {}).sha256);
  EXPECT_EQ(hashes.size(), 1U);
  EXPECT_EQ(hashes.begin()->size(), 64U);
}

INSTANTIATE_TEST_SUITE_P(Formats, ReplayOf,
                         testing::Values(real::kHermes, real::kHermesSimbody, real::kRem,
                                         real::Case{"roboteam-rem-v5", "roboteam_2024", Physics::kPlanar}),
                         [](const auto& each) {
                           std::string name =
                               std::string(each.param.radio) +
                               (each.param.physics == Physics::kPlanar ? "_planar" : "_simbody");
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

// Two teams with a dongle each: what the opponents' host writes drives them alone, and is in the recording.
TEST(Replay, OpponentsHaveTheirOwnDongleAndTheirBytesReplay) {
  SessionSetup setup = real::setup(real::kHermes);
  setup.opponent_ids = {0, 1};
  setup.opponents_radio = setup.radio_format;
  setup.field.contacts = true;
  setup.field.ball_m = {0.4, 0.2};
  RecordingHeader header = recording_header(setup, "abc1234");
  header.sample_every = 5;
  Session session(session_config(setup), make_reference_firmware);
  header.firmware = session.firmware(0).name();
  RecordingMemory memory(header);
  session.set_observer(&memory);
  const RadioFormat& format = *find_radio_format(setup.radio_format);
  real::Bytes out, opponents_out;
  for (int n = 0; n < 300; ++n) {
    const real::Bytes bytes = n % 20 == 0 ? real::host_bytes(format, {1}, n) : real::Bytes{};
    session.step({}, out, bytes, opponents_out);
  }
  EXPECT_EQ(session.robot_count(), 4);
  EXPECT_EQ(session.robot_key(3), kOpponentKey + 1);
  const auto speed = [&](int robot) {
    const PlanarState s = session.plant().planar_state(robot);
    return std::hypot(s.v_x_m_s, s.v_y_m_s);
  };
  EXPECT_GT(speed(3), 0.1);
  for (const int robot : {0, 1, 2}) EXPECT_EQ(speed(robot), 0.0);
  EXPECT_FALSE(opponents_out.empty());
  EXPECT_TRUE(out.empty());
  const Recording recorded = memory.take(session.now_ns());
  EXPECT_GT(count_of(recorded, RecordedChunk::Kind::kOpponentsBytes), 5U);
  EXPECT_GT(count_of(recorded, RecordedChunk::Kind::kBallSeen), 20U);
  const ReplayRun again = run_again(recorded, {});
  ASSERT_EQ(again.answer.chunks.size(), recorded.chunks.size());
  for (std::size_t i = 0; i < recorded.chunks.size(); ++i)
    EXPECT_EQ(again.answer.chunks[i].sample, recorded.chunks[i].sample) << i;
}

TEST(Replay, HostBytesReachTheLoopAtTheirTime) {
  Recording recorded = real::record(real::setup(real::kHermes), 60);
  const std::string before = run_again(recorded, {}).sha256;
  for (RecordedChunk& chunk : recorded.chunks) {
    if (chunk.kind == RecordedChunk::Kind::kHostBytes && chunk.now_ns == 20'000'000)
      chunk.now_ns += 1'000'000;
  }
  EXPECT_NE(run_again(recorded, {}).sha256, before);
}

TEST(Replay, ClosingThePortIsPartOfTheInput) {
  Recording recorded;
  recorded.header = recording_header(real::setup(real::kHermes), "abc1234");
  const auto& format = *find_radio_format("ulaval-hermes");
  const real::Bytes whole = real::frame(format, "GET_BATTERIE", {{"robot", 0}});
  const real::Bytes half(whole.begin(), whole.begin() + 3);
  const real::Bytes rest(whole.begin() + 3, whole.end());
  recorded.chunks = {{RecordedChunk::Kind::kHostBytes, 0, half, 0, {}},
                     {RecordedChunk::Kind::kHostBytes, 5'000'000, rest, 0, {}}};
  recorded.end_ns = 30'000'000;
  recorded.complete = true;
  EXPECT_FALSE(dongle_bytes_of(run_again(recorded, {}).answer).empty());
  // A dongle forgets the half packet of a host that left.
  recorded.chunks.insert(recorded.chunks.begin() + 1,
                         {RecordedChunk::Kind::kHostClosed, 2'000'000, {}, 0, {}});
  EXPECT_TRUE(dongle_bytes_of(run_again(recorded, {}).answer).empty());
}

TEST(Replay, RunsOnOtherPhysicsWhenAsked) {
  const Recording recorded = real::record(real::setup(real::kHermesSimbody), 30);
  const ReplayRun again = run_again(recorded, {.physics = Physics::kPlanar, .observer = nullptr});
  EXPECT_EQ(again.answer.header.plant.physics, Physics::kPlanar);
  EXPECT_EQ(again.answer.chunks.size(), recorded.chunks.size());
}

TEST(Replay, RefusesInputBetweenLoopSteps) {
  Recording recorded = real::record(real::setup(real::kHermes), 30);
  recorded.chunks.front().now_ns = 1;
  EXPECT_THROW(run_again(recorded, {}), BadRecording);
}

TEST(Replay, RefusesACloseAfterBytesOfTheSameTime) {
  Recording recorded = real::record(real::setup(real::kHermes), 30);
  RecordedChunk close;
  close.kind = RecordedChunk::Kind::kHostClosed;
  recorded.chunks.insert(recorded.chunks.begin() + 1, close);  // after the bytes of time 0
  ASSERT_EQ(recorded.chunks[0].kind, RecordedChunk::Kind::kHostBytes);
  EXPECT_THROW(run_again(recorded, {}), BadRecording);
}

TEST(Replay, RefusesAHeaderThatGivesNoSession) {
  Recording recorded = real::record(real::setup(real::kHermes), 10);
  recorded.header.radio_format = "smoke-signals";
  EXPECT_THROW(run_again(recorded, {}), std::invalid_argument);
  recorded.header.radio_format = "ulaval-hermes";
  recorded.header.robot_model_text = "format = 7";
  EXPECT_THROW(run_again(recorded, {}), std::invalid_argument);
}

TEST(Replay, RunCutAtAnyLineAgreesAsFarAsItGoes) {
  const std::string whole = real::text_of(real::record(real::setup(real::kHermes), 60));
  const auto& format = *find_radio_format("ulaval-hermes");
  Tolerances exact;
  exact.exact = true;
  std::size_t end = whole.find('\n') + 1;
  for (int line = 0; end != std::string::npos + 1 && end < whole.size(); ++line) {
    end = whole.find('\n', end) + 1;
    if (line % 7 != 0) continue;
    // The line end itself and half of the next line.
    const Recording cut = real::from_text(whole.substr(0, end + (line % 2 == 0 ? 0 : 9)));
    if (cut.complete) continue;
    const RecordingComparison comparison = compare_recordings(cut, run_again(cut, {}).answer, format, exact);
    EXPECT_TRUE(comparison.agrees()) << "cut after line " << line + 2 << ": " << comparison.first->text();
  }
}

TEST(OutputHash, OfNothingIsTheHashOfNothing) {
  EXPECT_EQ(OutputHash().hex(), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

TEST(OutputHash, SeesEveryColumnTimeRobotAndByte) {
  const RobotSample sample = fake::sample(1, 2);
  const auto hash_of = [](std::int64_t now_ns, const RobotSample& s, std::uint8_t byte) {
    OutputHash hash;
    hash.robot_tick(now_ns, s);
    hash.dongle_bytes(now_ns + 1, std::span(&byte, 1));
    return hash.hex();
  };
  std::set<std::string> hashes{hash_of(0, sample, 0), hash_of(1, sample, 0), hash_of(0, sample, 1)};
  RobotSample other = sample;
  other.robot_id = 2;
  hashes.insert(hash_of(0, other, 0));
  other = sample;
  other.sensors.encoder_counts[2] += 1;
  hashes.insert(hash_of(0, other, 0));
  other = sample;
  other.truth.load_N[3] = std::nextafter(other.truth.load_N[3], 1e9);  // one bit of the last column
  hashes.insert(hash_of(0, other, 0));
  EXPECT_EQ(hashes.size(), 6U);
}

TEST(OutputHash, ReadingItDoesNotChangeIt) {
  OutputHash once, twice;
  for (int n = 0; n < 5; ++n) {
    once.robot_tick(n, fake::sample(0, n));
    twice.robot_tick(n, fake::sample(0, n));
    EXPECT_EQ(twice.hex(), twice.hex());
  }
  EXPECT_EQ(once.hex(), twice.hex());
}

}  // namespace
}  // namespace omnihil
