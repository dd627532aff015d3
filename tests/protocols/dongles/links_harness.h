// What the tests of the links share: a host and robots around one link, on virtual time.
//
//   Bench bench("roboteam-rem-v8", {.robot_ids = {0, 3}});
//   bench.write(bench.encode("REM_RobotCommand", {{"toRobotId", 3}, {"rho", 1.0}}));
//   bench.run_to(20 * kMs);
//   EXPECT_EQ(bench.sink.heard.size(), 1u);
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <initializer_list>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "protocols/radio_format.h"
#include "protocols/radio_link.h"

namespace omnihil {

inline constexpr std::int64_t kUs = 1'000;
inline constexpr std::int64_t kMs = 1'000'000;
inline constexpr std::int64_t kS = 1'000'000'000;

using Bytes = std::vector<std::uint8_t>;
using FieldValues = std::initializer_list<std::pair<const char*, double>>;

struct Heard {
  Delivery::Kind kind = Delivery::Kind::kCommand;
  int robot = 0;
  RobotCommand command{};
  RobotGains gains{};
  Bytes frame;
  std::string message;
  std::int64_t at_ns = 0;
};

inline bool same(const Heard& a, const Heard& b) {
  return a.kind == b.kind && a.robot == b.robot && a.frame == b.frame && a.message == b.message &&
         a.at_ns == b.at_ns && std::memcmp(&a.command, &b.command, sizeof a.command) == 0 &&
         std::memcmp(&a.gains, &b.gains, sizeof a.gains) == 0;
}
inline bool same(const std::vector<Heard>& a, const std::vector<Heard>& b) {
  bool equal = a.size() == b.size();
  for (std::size_t i = 0; equal && i < a.size(); ++i) equal = same(a[i], b[i]);
  return equal;
}

struct Sink final : RadioSink {
  std::vector<Heard> heard;
  void deliver(const Delivery& d, std::int64_t now_ns) override {
    heard.push_back({d.kind, d.robot_id, d.command, d.gains, Bytes(d.frame.begin(), d.frame.end()),
                     std::string(d.message), now_ns});
  }
  std::vector<Heard> of_robot(int id) const {
    std::vector<Heard> one;
    for (const Heard& h : heard) {
      if (h.robot == id) one.push_back(h);
    }
    return one;
  }
};

inline Bytes encode(const RadioFormat& format, const char* message, FieldValues fields,
                    std::string_view text = {}) {
  Values values;
  values.message = format.find(message);
  EXPECT_NE(values.message, nullptr) << message;
  for (const auto& [name, number] : fields) values.set(name, number);
  values.text = text;
  Bytes out;
  const auto result = format.encode(values, out);
  EXPECT_EQ(result.error, PacketError::kNone) << message << " " << result.field;
  return out;
}

inline Bytes operator+(Bytes a, const Bytes& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

struct Bench {
  Bench(const char* id, const RadioLinkConfig& c) : Bench(*find_radio_format(id), c) {}
  Bench(const RadioFormat& f, const RadioLinkConfig& c)
      : format(f), config(c), link(format.make_link(config)) {}

  Bytes encode(const char* message, FieldValues fields, std::string_view text = {}) const {
    return omnihil::encode(format, message, fields, text);
  }
  void write(const Bytes& bytes) { link->host_bytes(bytes, now_ns); }
  void write_byte_by_byte(const Bytes& bytes) {
    for (std::size_t i = 0; i < bytes.size(); ++i) link->host_bytes(std::span(bytes).subspan(i, 1), now_ns);
  }
  // One loop step, in the order of the contract.
  void step() {
    link->poll(now_ns, sink);
    for (const auto& [id, feedback] : robots) link->robot_feedback(id, feedback, gains, now_ns);
    link->take_host_bytes(now_ns, to_host);
  }
  void run_to(std::int64_t end_ns, std::int64_t step_ns = 100 * kUs) {
    step();
    while (now_ns < end_ns) {
      now_ns = std::min(now_ns + step_ns, end_ns);
      step();
    }
  }
  void boot_robots() {
    for (const int id : config.robot_ids) robots[id] = RobotFeedback{};
  }
  std::uint64_t refused(PacketError cause) const {
    return link->from_host().bad[static_cast<std::size_t>(cause)];
  }
  std::uint64_t good() const { return link->from_host().good; }

  // Packets among the bytes that reached the host; `name` empty: all. Framing by the format.
  std::vector<DecodeResult> answers(std::string_view name = {}) const;

  const RadioFormat& format;
  RadioLinkConfig config;
  std::unique_ptr<RadioLink> link;
  Sink sink;
  std::map<int, RobotFeedback> robots;
  RobotGains gains{};
  Bytes to_host;
  std::int64_t now_ns = 0;
};

// Of the shortest frame that the bytes begin with, or of all of them.
inline std::size_t first_packet_bytes(const RadioFormat& format, std::span<const std::uint8_t> bytes) {
  for (std::size_t size = 1; size < bytes.size(); ++size) {
    if (format.decode(bytes.first(size)).error == PacketError::kNone) return size;
  }
  return bytes.size();
}

inline std::vector<DecodeResult> Bench::answers(std::string_view name) const {
  std::vector<DecodeResult> all;
  for (std::size_t at = 0; at < to_host.size();) {
    const std::span<const std::uint8_t> rest = std::span(to_host).subspan(at);
    const std::size_t size =
        std::max<std::size_t>(1, std::min(rest.size(), first_packet_bytes(format, rest)));
    const DecodeResult result = format.decode(rest.first(size));
    EXPECT_EQ(result.error, PacketError::kNone) << "at byte " << at;
    if (result.error == PacketError::kNone && (name.empty() || result.values.message->name == name)) {
      all.push_back(result);
    }
    at += size;
  }
  return all;
}

}  // namespace omnihil
