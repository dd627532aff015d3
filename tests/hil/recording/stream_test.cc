#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <set>
#include <thread>

#include "hil/recording/stream_file.h"
#include "hil/recording/stream_frames.h"
#include "hil/serve/stream_player.h"
#include "hil/wire/open_wire.h"
#include "tests/hil/recording/real_run.h"

namespace omnihil {
namespace {

using real::Bytes;

std::string fault_of(const std::string& text, const std::string& session = "") {
  try {
    parse_stream(text, "s.txt", session);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "was taken";
}

TEST(StreamFile, TextHasTimesBytesAndComments) {
  const HostStream stream =
      parse_stream("# host\n0 03ff00\n\n0.0333 00 # a lone end\n  1.5 aB\n", "s.txt", "");
  ASSERT_EQ(stream.chunks.size(), 3U);
  EXPECT_EQ(stream.chunks[0].at_ns, 0);
  EXPECT_EQ(stream.chunks[0].bytes, (Bytes{0x03, 0xff, 0x00}));
  EXPECT_EQ(stream.chunks[1].at_ns, 33'300'000);
  EXPECT_EQ(stream.chunks[2].bytes, Bytes{0xab});
  EXPECT_EQ(stream.duration_ns(), 1'500'000'000);
  EXPECT_EQ(stream.byte_count(), 5U);
}

TEST(StreamFile, JsonSessionIsPickedByName) {
  const std::string one = R"({"format": "x", "sessions": {"lineup": [[0.0, "0300"], [0.5, "04"]]}})";
  EXPECT_EQ(parse_stream(one, "s.json", "").chunks.size(), 2U);
  EXPECT_EQ(parse_stream(one, "s.json", "lineup").session, "lineup");
  const std::string two = R"({"sessions": {"a": [[0, "00"]], "b": [[0, "01"], [1, "02"]]}})";
  EXPECT_EQ(parse_stream(two, "s.json", "b").chunks.size(), 2U);
  EXPECT_NE(fault_of(two).find("allowed: a, b"), std::string::npos) << fault_of(two);
  EXPECT_NE(fault_of(two, "c").find("allowed: a, b"), std::string::npos);
}

TEST(StreamFile, RecordingGivesItsHostsBytes) {
  const Recording recorded = real::record(real::setup(real::kHermes), 50);
  const HostStream stream = parse_stream(real::text_of(recorded), "run.omnirec", "");
  ASSERT_EQ(stream.chunks.size(), 4U);  // at 0, 20, 33 and 40 ms
  EXPECT_EQ(stream.chunks[2].at_ns, 33'000'000);
  EXPECT_EQ(stream.chunks[2].bytes, (Bytes{0x11, 0x22, 0x00, 0x33}));
}

TEST(StreamFile, TextComesBackAsWritten) {
  const HostStream stream = parse_stream("0 03ff00\n0.0333 00\n7.123456789 ab\n", "s.txt", "");
  const HostStream again = parse_stream(to_text(stream, "copy"), "t.txt", "");
  ASSERT_EQ(again.chunks.size(), stream.chunks.size());
  for (std::size_t i = 0; i < stream.chunks.size(); ++i) {
    EXPECT_EQ(again.chunks[i].at_ns, stream.chunks[i].at_ns);
    EXPECT_EQ(again.chunks[i].bytes, stream.chunks[i].bytes);
  }
}

TEST(StreamFile, FaultsAreNamedWithPlaceFoundAndAllowed) {
  const std::pair<const char*, const char*> faults[] = {
      {"x 00\n", "s.txt:1: time: found 'x'"},
      {"0 00\n-1 00\n", "s.txt:2: time: found '-1'"},
      {"nan 00\n", "s.txt:1: time"},
      {"1e300 00\n", "s.txt:1: time"},
      {"1 00\n0.5 00\n", "s.txt:2: time: found '0.5', allowed: 1.0"},
      {"0 0\n", "s.txt:1: bytes: found '0'"},
      {"0 zz\n", "s.txt:1: bytes: found 'zz'"},
      {"0\n", "s.txt:1: bytes: found ''"},
      {"0 00 00\n", "s.txt:1: line"},
      {"", "no bytes to play"},
      {"# only a comment\n", "no bytes to play"},
      {"{", "s.txt: found '{'"},
      {"{}", "sessions"},
      {R"({"sessions": {}})", "session"},
      {R"({"sessions": {"a": []}})", "no bytes to play"},
      {R"({"sessions": {"a": [[0]]}})", "session 'a' row 1"},
      {R"({"sessions": {"a": [[0, "00"], ["1", "00"]]}})", "session 'a' row 2"},
      {R"({"sessions": {"a": [[0, "0x"]]}})", "session 'a' row 1: bytes"},
      {R"(# {"format":"omnihil-recording/9"})"
       "\n",
       "s.txt:1: header"},
  };
  for (const auto& [text, message] : faults) {
    EXPECT_NE(fault_of(text).find(message), std::string::npos) << text << " -> " << fault_of(text);
  }
  EXPECT_NE(fault_of("0 00\n", "lineup").find("no sessions"), std::string::npos);
}

TEST(StreamFile, ShippedDriveIsSixRobotsWithNoFrameRefused) {
  const HostStream stream = load_stream(OMNIHIL_SOURCE_DIR "/examples/streams/hermes-drive.txt", "");
  const RadioFormat& format = *find_radio_format("ulaval-hermes");
  std::set<int> robots;
  for (const StreamChunk& chunk : stream.chunks) {
    const DecodeResult frame = format.decode(chunk.bytes);
    ASSERT_EQ(frame.error, PacketError::kNone) << to_hex(chunk.bytes);
    robots.insert(static_cast<int>(frame.values.number("robot")));
  }
  EXPECT_EQ(robots, (std::set<int>{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(stream.duration_ns(), 8'020'000'000);
}

TEST(StreamFile, RealHostsStreamIsReadWhole) {
  const char* shared = std::getenv("OMNIHIL_SHARED");
  if (shared == nullptr) GTEST_SKIP() << "OMNIHIL_SHARED is not set: no stream of a real host";
  const auto path = std::filesystem::path(shared) / "vectors/ulaval-strategyai-host-stream.json";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no stream of a real host in OMNIHIL_SHARED";
  const HostStream stream = load_stream(path, "lineup");
  EXPECT_EQ(stream.chunks.size(), 1035U);
  EXPECT_EQ(stream.duration_ns(), 6'766'400'000);
}

std::vector<FrameCutter::Frame> cut(FrameCutter& cutter) {
  std::vector<FrameCutter::Frame> frames;
  while (auto frame = cutter.next()) frames.push_back(std::move(*frame));
  return frames;
}

TEST(FrameCutter, GivesTheFramesHoweverTheyArriveCut) {
  for (const char* id : {"ulaval-hermes", "roboteam-rem-v8", "roboteam-rem-v5"}) {
    const RadioFormat& format = *find_radio_format(id);
    std::vector<Bytes> frames;
    Bytes all;
    for (const Message& message : format.messages) {
      Values values;
      values.message = &message;
      for (const Field& field : message.fields) {
        if (field.lo > 0.0) values.set(field.name, field.lo);
      }
      frames.emplace_back();
      ASSERT_EQ(format.encode(values, frames.back()).error, PacketError::kNone) << message.name;
      all.insert(all.end(), frames.back().begin(), frames.back().end());
    }
    for (const std::size_t piece : {std::size_t{1}, std::size_t{7}, all.size()}) {
      FrameCutter cutter(format);
      std::vector<FrameCutter::Frame> got;
      for (std::size_t at = 0; at < all.size(); at += piece) {
        cutter.push(std::span(all).subspan(at, std::min(piece, all.size() - at)));
        for (auto& frame : cut(cutter)) got.push_back(std::move(frame));
      }
      ASSERT_EQ(got.size(), frames.size()) << id << " in pieces of " << piece;
      std::uint64_t offset = 0;
      for (std::size_t i = 0; i < frames.size(); ++i) {
        EXPECT_TRUE(got[i].understood);
        EXPECT_EQ(got[i].bytes, frames[i]);
        EXPECT_EQ(got[i].offset, offset);
        offset += frames[i].size();
      }
    }
  }
}

TEST(FrameCutter, GivesDamageApartAndFindsTheNextFrame) {
  const RadioFormat& format = *find_radio_format("ulaval-hermes");
  Bytes damaged = real::frame(format, "GET_BATTERIE", {{"robot", 1}});
  const Bytes sound = real::frame(format, "GET_BATTERIE", {{"robot", 2}});
  damaged[2] ^= 0x40;
  FrameCutter cutter(format);
  cutter.push(damaged);
  cutter.push(sound);
  cutter.push(Bytes{0x05});
  cutter.finish();
  const auto frames = cut(cutter);
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_FALSE(frames[0].understood);
  EXPECT_EQ(frames[0].bytes, damaged);
  EXPECT_TRUE(frames[1].understood);
  EXPECT_EQ(frames[1].bytes, sound);
  EXPECT_FALSE(frames[2].understood);
  EXPECT_EQ(frames[2].bytes, Bytes{0x05});
}

// The far end of a serial line: what a dongle's operating system holds.
class FarEnd {
 public:
  FarEnd() : fd_(::posix_openpt(O_RDWR | O_NOCTTY)) {
    EXPECT_GE(fd_, 0);
    EXPECT_EQ(::grantpt(fd_), 0);
    EXPECT_EQ(::unlockpt(fd_), 0);
    path_ = ::ptsname(fd_);
  }
  ~FarEnd() { hang_up(); }
  FarEnd(const FarEnd&) = delete;
  FarEnd& operator=(const FarEnd&) = delete;
  void hang_up() {
    if (fd_ >= 0) ::close(fd_);
    fd_ = -1;
  }
  const std::string& path() const { return path_; }
  Bytes read_until(std::size_t count) const {
    Bytes all;
    while (all.size() < count) {
      pollfd entry{fd_, POLLIN, 0};
      if (::poll(&entry, 1, 10'000) <= 0) break;  // a guard against hanging, not a measurement
      std::uint8_t buffer[4096];
      const ssize_t n = ::read(fd_, buffer, sizeof buffer);
      if (n <= 0) break;
      all.insert(all.end(), buffer, buffer + n);
    }
    return all;
  }
  void write(const Bytes& bytes) const {
    EXPECT_EQ(::write(fd_, bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  }

 private:
  int fd_;
  std::string path_;
};

TEST(StreamPlayer, WritesEveryByteUnchangedAndCountsWhatComesBack) {
  FarEnd dongle;
  WireProblem problem;
  const auto port = open_byte_wire(read_wire_url(dongle.path(), "serial"), {}, problem);
  ASSERT_TRUE(port) << problem.text();
  Bytes every(256);
  for (std::size_t i = 0; i < every.size(); ++i) every[i] = static_cast<std::uint8_t>(i);
  HostStream stream;
  for (int n = 0; n < 40; ++n) stream.chunks.push_back({n * 1'000'000LL, every});
  const RadioFormat& format = *find_radio_format("ulaval-hermes");
  dongle.write(real::frame(format, "PING_RESPONSE", {{"robot", 1}}));
  dongle.write(real::frame(format, "BATTERIE_RESPONSE", {{"robot", 1}, {"decivolts", 148}}));
  dongle.write({0x7f});
  Bytes got;
  std::thread reader([&] { got = dongle.read_until(40 * 256); });
  const volatile std::sig_atomic_t go_on = 0;
  const PlaySummary summary = play_stream(stream, *port, {.linger_s = 0.05, .format = &format}, go_on);
  reader.join();
  ASSERT_EQ(got.size(), 40U * 256U);
  for (std::size_t i = 0; i < got.size(); ++i) ASSERT_EQ(got[i], static_cast<std::uint8_t>(i)) << i;
  EXPECT_EQ(summary.writes, 40U);
  EXPECT_EQ(summary.bytes_written, 40U * 256U);
  EXPECT_EQ(summary.rounds, 1U);
  EXPECT_FALSE(summary.error);
  EXPECT_EQ(summary.packets.at("PING_RESPONSE"), 1U);
  EXPECT_EQ(summary.packets.at("BATTERIE_RESPONSE"), 1U);
  EXPECT_EQ(summary.bytes_not_understood, 1U);
}

TEST(StreamPlayer, EndsWithAnErrorWhenTheDeviceIsUnplugged) {
  FarEnd dongle;
  WireProblem problem;
  const auto port = open_byte_wire(read_wire_url(dongle.path(), "serial"), {}, problem);
  ASSERT_TRUE(port) << problem.text();
  dongle.hang_up();
  HostStream stream;
  stream.chunks = {{0, {1}}, {3'600'000'000'000, {2}}};  // an hour: it must not be waited for
  const volatile std::sig_atomic_t go_on = 0;
  const PlaySummary summary = play_stream(stream, *port, {}, go_on);
  EXPECT_TRUE(summary.error);
  EXPECT_EQ(summary.rounds, 0U);
}

TEST(StreamPlayer, StopsWhenAsked) {
  FarEnd dongle;
  WireProblem problem;
  const auto port = open_byte_wire(read_wire_url(dongle.path(), "serial"), {}, problem);
  ASSERT_TRUE(port) << problem.text();
  HostStream stream;
  stream.chunks = {{0, {1}}, {3'600'000'000'000, {2}}};
  const volatile std::sig_atomic_t stop = 1;
  const PlaySummary summary = play_stream(stream, *port, {.loop = true}, stop);
  EXPECT_TRUE(summary.stopped);
  EXPECT_EQ(summary.bytes_written, 0U);
}

TEST(SerialWire, RefusesWhatIsNoSerialDevice) {
  const fake::TempFolder folder;
  fake::write_text(folder / "file", "text");
  WireProblem problem;
  EXPECT_FALSE(open_byte_wire({"serial", folder / "file", {}}, {}, problem));
  EXPECT_EQ(problem.code.value(), ENOTTY);
  EXPECT_FALSE(open_byte_wire({"serial", folder / "nothing", {}}, {}, problem));
  EXPECT_EQ(problem.code, std::errc::no_such_file_or_directory);
}

}  // namespace
}  // namespace omnihil
