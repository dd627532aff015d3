#include "hil/acquire/remote_axis.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "hil/loop/clock.h"

namespace omnihil {
namespace {

constexpr std::int64_t kPatience_ns = 3'000'000'000;
constexpr std::size_t kBite_bytes = 1024;

}  // namespace

RemoteAxis::RemoteAxis(BufferedWire wire, int motor) : wire_(std::move(wire)), motor_(motor) {
  sent_.fill(AxisMoment::kNotTold);
  omnihil_remote_init(&shim_, "omnihil acquire", "", 0, &RemoteAxis::write, this);
}

void RemoteAxis::write(void* self, const std::uint8_t* bytes, std::size_t count) {
  auto& axis = *static_cast<RemoteAxis*>(self);
  axis.wire_.write({bytes, count});
  axis.log('>', {bytes, count});
}

void RemoteAxis::log(char way, std::span<const std::uint8_t> bytes) {
  fmt::format_to(std::back_inserter(log_), "{:.6f} {} ", 1e-9 * static_cast<double>(now_ns_), way);
  for (const std::uint8_t byte : bytes) fmt::format_to(std::back_inserter(log_), "{:02x}", byte);
  log_ += '\n';
}

// A board that was driven before says HELLO again when its time-out has run off.
bool RemoteAxis::greet(std::string& problem) {
  const std::int64_t start_ns = monotonic_now_ns();
  const std::uint8_t clear_line[] = {0, 0};
  wire_.write(clear_line);
  std::vector<std::uint8_t> bytes;
  while (shim_.configured == 0 && wire_.failure().empty() && monotonic_now_ns() - start_ns < kPatience_ns) {
    wire_.wait(10'000'000);
    bytes.clear();
    wire_.read(bytes, kBite_bytes);
    for (const std::uint8_t byte : bytes) omnihil_remote_receive(&shim_, byte);
  }
  wire_.flush();
  log_.clear();
  if (shim_.configured != 0) return true;
  problem = !wire_.failure().empty()
                ? std::string(wire_.failure())
                : fmt::format(
                      "{}: the board says no HELLO within {} s ({} good frames came, {} with a bad checksum)",
                      wire_.name(), kPatience_ns / 1'000'000'000, shim_.decoder.good, shim_.decoder.bad_crc);
  return false;
}

double RemoteAxis::counts_per_turn() const {
  return std::abs(static_cast<double>(shim_.robot.encoder_counts_per_rotor_turn));
}

void RemoteAxis::ask(double value, std::int64_t now_ns) {
  now_ns_ = now_ns;
  asked_ = value;
}

// Not with the next sensors: at once.
void RemoteAxis::stop(std::int64_t now_ns) {
  now_ns_ = now_ns;
  const bool drove = std::isfinite(asked_);
  asked_ = AxisMoment::kNotTold;
  if (drove) answer();
}

void RemoteAxis::answer() {
  if (std::isfinite(asked_)) {
    omnihil_remote_set_duty(&shim_, motor_, static_cast<float>(asked_));
    sent_[shim_.sequence] = std::max(-1.0, shim_.duty[motor_] / 32767.0);
  } else {
    omnihil_remote_coast(&shim_, motor_);
    sent_[shim_.sequence] = AxisMoment::kNotTold;
  }
  omnihil_remote_done(&shim_, 0);
}

AxisMoment RemoteAxis::reading(std::int64_t now_ns) {
  const omnihil_remote_sensors& s = shim_.sensors;
  const auto counts = static_cast<std::uint32_t>(s.encoder_counts[motor_]);
  if (!first_) {
    board_us_ += s.now_us - last_us_;
    counts_ += static_cast<std::int32_t>(counts - last_counts_);
    lost_frames_ += static_cast<std::uint16_t>(shim_.sequence - last_number_ - 1U);
  }
  first_ = false;
  last_us_ = s.now_us, last_counts_ = counts, last_number_ = shim_.sequence;
  const omnihil_remote_robot& r = shim_.robot;
  const double falls = r.encoder_counts_per_rotor_turn < 0.0F ? -1.0 : 1.0;
  AxisMoment out{.now_ns = now_ns, .time_s = 1e-6 * static_cast<double>(board_us_)};
  out.counts = falls * static_cast<double>(counts_);
  out.position_rad = out.counts / counts_per_turn() * 2.0 * std::numbers::pi / r.gear_ratio;
  out.current_A = 1e-3 * s.motor_current_mA[motor_];
  out.bus_V = 1e-3 * s.bus_voltage_mV;
  out.value = s.drive_number != 0 ? sent_[s.drive_number] : AxisMoment::kNotTold;
  return out;
}

void RemoteAxis::read(std::int64_t now_ns, std::vector<AxisMoment>& out) {
  now_ns_ = now_ns;
  std::vector<std::uint8_t> bytes;
  do {
    bytes.clear();
    wire_.read(bytes, kBite_bytes);
    if (!bytes.empty()) log('<', bytes);
    for (const std::uint8_t byte : bytes) {
      omnihil_remote_receive(&shim_, byte);
      if (omnihil_remote_tick(&shim_) == 0) continue;
      out.push_back(reading(now_ns));
      answer();
    }
  } while (bytes.size() == kBite_bytes);
  wire_.flush();
}

}  // namespace omnihil
