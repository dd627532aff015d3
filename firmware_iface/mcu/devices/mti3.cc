// Xsens MTi-3 (MTi 1-series) inertial unit on SPI: the synchronous protocol MTSSP and the Xbus messages through it (data
// sheet MT0512P chapter 3; MT low-level communication protocol MT0101P).
//
// A transfer is an opcode, three fill bytes and data: 0x01 and 0x02 read and set the DRDY pin's meaning, 0x03 brings a
// message, 0x04 gives the sizes that wait in the two pipes, 0x05 and 0x06 read them. Messages are without preamble and bus
// id, with a checksum that makes their sum with FFh zero. After reset it says WakeUp (0.3 s: guess), and measures unless it
// is answered within half a second. Replies come a millisecond after their question (guess). Outputs: packet counter, fine
// sample time, Euler angles, acceleration, free acceleration, rate of turn, status word, each at its own rate. Yaw is the
// sum of the rate of turn since reset. Pins: in `reset` (low resets), out `drdy`. Settings: direction (1, or -1: upside
// down). Cannot represent: its filters and their profiles, biases, magnetometer, other outputs (answered as invalid).
#include <algorithm>
#include <bit>
#include <cstdint>
#include <deque>
#include <memory>
#include <utility>

#include "firmware_iface/mcu/stm32/device.h"

namespace omnihil::mcu {
namespace {
using Bytes = std::vector<std::uint8_t>;
enum Opcode : std::uint8_t {
  kReadProtocol = 1,
  kSetProtocol = 2,
  kControlPipe = 3,
  kPipeStatus = 4,
  kNotifications = 5,
  kMeasurements = 6
};
enum Message : std::uint8_t {
  kGoToMeasurement = 0x10,
  kSetNoRotation = 0x22,
  kGoToConfig = 0x30,
  kMtData2 = 0x36,
  kWakeUp = 0x3E,
  kWakeUpAck = 0x3F,
  kError = 0x42,
  kSetOutput = 0xC0
};
constexpr std::uint16_t kCounter = 0x1020, kTimeFine = 0x1060, kEuler = 0x2030, kAcceleration = 0x4020,
                        kFreeAcceleration = 0x4030, kRateOfTurn = 0x8020, kStatusWord = 0xE020;
constexpr std::int64_t kStarts_ns = 300'000'000, kWaits_ns = 500'000'000, kReplies_ns = 1'000'000;
constexpr unsigned kFastest_Hz = 800;
constexpr double kGravity_m_s2 = 9.80665, kDegPerRad = 57.29577951308232;

struct Output {
  std::uint16_t id = 0, rate_Hz = 0;
};

class Mti3 final : public Device, public SpiDevice {
 public:
  explicit Mti3(const DeviceWorld& world) : world_(world) {}
  void reset() override {
    if (!held_) start();
  }
  SpiDevice* spi() override { return this; }
  std::span<const std::string_view> inputs() const override {
    static constexpr std::string_view kPins[] = {"reset"};
    return kPins;
  }
  std::span<const std::string_view> outputs() const override {
    static constexpr std::string_view kPins[] = {"drdy"};
    return kPins;
  }
  void input(std::string_view, bool level) override {
    const bool was = std::exchange(held_, !level);
    if (was && level) start();
    if (!level) {
      clear();
      plan();
    }
  }

  void select(bool selected) override {
    if (!selected && count_ >= 4) finish();
    count_ = 0;
    written_.clear();
  }
  std::uint8_t exchange(std::uint8_t from_master) override {
    const std::size_t at = count_++;
    if (at == 0) opcode_ = from_master;
    if (at < 4) return 0xFA;
    written_.push_back(from_master);
    const std::size_t i = at - 4;
    const auto of = [i](const Bytes& bytes) { return i < bytes.size() ? bytes[i] : std::uint8_t{0}; };
    switch (opcode_) {
      case kReadProtocol:
        return i == 0 ? 1 : i == 1 ? drdy_ : std::uint8_t{0};
      case kPipeStatus: {
        const std::size_t n = i < 2 ? (notes_.empty() ? 0 : notes_.front().size()) : measured_.size();
        return static_cast<std::uint8_t>(i % 2 == 0 ? n : n >> 8);
      }
      case kNotifications:
        return notes_.empty() ? std::uint8_t{0} : of(notes_.front());
      case kMeasurements:
        return of(measured_);
      default:
        return 0;
    }
  }

  void woken() override {
    const std::int64_t now_ns = world_.now_ns();
    while (!replies_.empty() && replies_.front().first <= now_ns) {
      notes_.push_back(std::move(replies_.front().second));
      replies_.pop_front();
      told();
    }
    if (!awake_ && wakes_ns_ <= now_ns) {
      awake_ = true;
      note(kWakeUp, {});
      sample_ns_ = now_ns + kWaits_ns;  // measures then, unless answered
    }
    while (awake_ && sample_ns_ != kNoWake && sample_ns_ <= now_ns) sample();
    plan();
  }

 private:
  void clear() {
    notes_.clear();
    replies_.clear();
    measured_.clear();
    awake_ = false;
    wakes_ns_ = sample_ns_ = kNoWake;
    drdy_ = 0x0C;
    show(false);
  }
  void start() {
    clear();
    outputs_ = {{kCounter, 100}, {kTimeFine, 100}, {kEuler, 100}, {kStatusWord, 100}};
    ticks_ = 0;
    packets_ = 0;
    yaw_rad_ = 0.0;
    still_until_ns_ = 0;
    started_ns_ = world_.now_ns();
    wakes_ns_ = started_ns_ + kStarts_ns;
    plan();
  }

  void finish() {
    switch (opcode_) {
      case kSetProtocol:
        if (!written_.empty()) drdy_ = written_[0];
        break;
      case kControlPipe:
        hear();
        break;
      case kNotifications:
        if (!notes_.empty()) notes_.pop_front();
        break;
      case kMeasurements:
        measured_.clear();
        break;
      default:
        return;
    }
    show(waiting());
    plan();
  }

  static Bytes message(std::uint8_t id, const Bytes& data) {
    Bytes all{id, static_cast<std::uint8_t>(data.size())};
    all.insert(all.end(), data.begin(), data.end());
    std::uint8_t sum = 0xFF;
    for (const std::uint8_t byte : all) sum = static_cast<std::uint8_t>(sum + byte);
    all.push_back(static_cast<std::uint8_t>(-sum));
    return all;
  }
  void note(std::uint8_t id, const Bytes& data) {
    notes_.push_back(message(id, data));
    told();
  }
  void reply(std::uint8_t id, const Bytes& data = {}) {
    replies_.emplace_back(world_.now_ns() + kReplies_ns, message(id, data));
  }

  // A message from the control pipe: id, length, data, checksum.
  void hear() {
    if (!awake_ || written_.size() < 3 || written_.size() < 3u + written_[1]) return;
    const std::size_t n = written_[1];
    std::uint8_t sum = 0xFF;
    for (std::size_t i = 0; i < n + 3; ++i) sum = static_cast<std::uint8_t>(sum + written_[i]);
    if (sum != 0) return;
    const std::uint8_t id = written_[0];
    const Bytes data(written_.begin() + 2, written_.begin() + 2 + static_cast<std::ptrdiff_t>(n));
    const auto acknowledge = static_cast<std::uint8_t>(id + 1);
    switch (id) {
      case kWakeUpAck:
        sample_ns_ = kNoWake;
        return;
      case kGoToConfig:
        sample_ns_ = kNoWake;
        return reply(acknowledge);
      case kGoToMeasurement:
        sample_ns_ = world_.now_ns() + 1'000'000'000 / kFastest_Hz;
        return reply(acknowledge);
      case kSetOutput:
        return set_outputs(data, acknowledge);
      case kSetNoRotation:
        if (n == 2) still_until_ns_ = world_.now_ns() + 1'000'000'000 * std::int64_t{data[0] << 8 | data[1]};
        return reply(acknowledge);
      default:
        return reply(acknowledge);
    }
  }

  void set_outputs(const Bytes& data, std::uint8_t acknowledge) {
    constexpr std::uint8_t kInvalid = 0x21;
    std::vector<Output> outputs;
    for (std::size_t i = 0; i + 4 <= data.size(); i += 4) {
      const Output output{static_cast<std::uint16_t>(data[i] << 8 | data[i + 1]),
                          static_cast<std::uint16_t>(data[i + 2] << 8 | data[i + 3])};
      if (item(output.id).empty()) return reply(kError, {kInvalid});
      outputs.push_back(output);
    }
    outputs_ = std::move(outputs);
    reply(acknowledge, data);
  }

  static void put(Bytes& bytes, std::uint32_t value, unsigned size) {
    while (size-- > 0) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * size)));
  }
  static void put_floats(Bytes& bytes, double a, double b, double c) {
    for (const double value : {a, b, c})
      put(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(value)), 4);
  }
  double gyro_rad_s() const {
    return world_.gyro_z_rad_s ? world_.setting("direction", 1.0) * world_.gyro_z_rad_s(world_.now_ns())
                               : 0.0;
  }

  // The data of one output; empty: it is not modelled.
  Bytes item(std::uint16_t id) const {
    const std::int64_t now_ns = world_.now_ns();
    const double up = world_.setting("direction", 1.0);
    const double x = world_.accel_x_m_s2 ? world_.accel_x_m_s2(now_ns) : 0.0;
    const double y = world_.accel_y_m_s2 ? up * world_.accel_y_m_s2(now_ns) : 0.0;
    Bytes bytes;
    switch (id) {
      case kCounter:
        put(bytes, packets_, 2);
        break;
      case kTimeFine:
        put(bytes, static_cast<std::uint32_t>((now_ns - started_ns_) / 100'000), 4);
        break;
      case kEuler: {
        double yaw = yaw_rad_ * kDegPerRad;
        while (yaw > 180.0) yaw -= 360.0;
        while (yaw < -180.0) yaw += 360.0;
        put_floats(bytes, up > 0 ? 0.0 : 180.0, 0.0, yaw);
        break;
      }
      case kAcceleration:
        put_floats(bytes, x, y, up * kGravity_m_s2);
        break;
      case kFreeAcceleration:
        put_floats(bytes, x, y, 0.0);
        break;
      case kRateOfTurn:
        put_floats(bytes, 0.0, 0.0, gyro_rad_s());
        break;
      case kStatusWord:  // self test, filter valid; both bits of "no rotation" while that is asked for
        put(bytes, 3u | (now_ns < still_until_ns_ ? 0x18u : 0u), 4);
        break;
      default:
        break;
    }
    return bytes;
  }

  void sample() {
    sample_ns_ += 1'000'000'000 / kFastest_Hz;
    yaw_rad_ += gyro_rad_s() / kFastest_Hz;
    const unsigned tick = ticks_++;
    Bytes data;
    for (const Output& output : outputs_) {
      const unsigned every =
          output.rate_Hz == 0 || output.rate_Hz > kFastest_Hz ? 1 : kFastest_Hz / output.rate_Hz;
      if (tick % every != 0) continue;
      const Bytes value = item(output.id);
      put(data, output.id, 2);
      data.push_back(static_cast<std::uint8_t>(value.size()));
      data.insert(data.end(), value.begin(), value.end());
    }
    if (data.empty()) return;
    ++packets_;
    measured_ = message(kMtData2, data);
    told();
  }

  bool waiting() const {
    return ((drdy_ & 4u) != 0 && !notes_.empty()) || ((drdy_ & 8u) != 0 && !measured_.empty());
  }
  // Something new waits: an edge, even where the pin was up already.
  void told() {
    if (!waiting()) return;
    show(false);
    show(true);
  }
  void show(bool ready) { output("drdy", ready != ((drdy_ & 1u) != 0)); }
  void plan() {
    std::int64_t next_ns = awake_ ? sample_ns_ : wakes_ns_;
    if (!replies_.empty() && (next_ns == kNoWake || replies_.front().first < next_ns))
      next_ns = replies_.front().first;
    world_.wake_at(next_ns);
  }

  DeviceWorld world_;
  std::vector<Output> outputs_;
  std::deque<Bytes> notes_;
  std::deque<std::pair<std::int64_t, Bytes>> replies_;
  Bytes measured_, written_;
  bool held_ = false, awake_ = false;
  std::uint8_t drdy_ = 0x0C, opcode_ = 0;
  std::uint16_t packets_ = 0;
  unsigned ticks_ = 0;
  double yaw_rad_ = 0.0;
  std::int64_t started_ns_ = 0, wakes_ns_ = kNoWake, sample_ns_ = kNoWake, still_until_ns_ = 0;
  std::size_t count_ = 0;
};
}  // namespace

const DeviceKind& device_mti3() {
  static const DeviceKind kind{
      "mti3",
      "Xsens MTi-3 inertial unit on SPI, pins reset and drdy",
      {"direction"},
      [](const DeviceWorld& world) -> std::unique_ptr<Device> { return std::make_unique<Mti3>(world); }};
  return kind;
}

}  // namespace omnihil::mcu
