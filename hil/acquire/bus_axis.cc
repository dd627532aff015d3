#include "hil/acquire/bus_axis.h"

#include <fmt/format.h>

#include <numbers>

namespace omnihil {

BusAxisSetup bus_axis_setup(AxisDemand demand, bool at_rotor, double gear_ratio, bool amplitudes) {
  BusAxisSetup s{.demand = demand, .turns_per_output = at_rotor ? gear_ratio : 1.0};
  if (demand == AxisDemand::kTorque && !at_rotor) s.device_per_asked = gear_ratio;
  if (demand == AxisDemand::kVoltage && amplitudes) s.device_per_asked = 1.0 / std::numbers::sqrt3;
  if (amplitudes) s.current_per_told = 0.5 * std::numbers::sqrt3;
  return s;
}

void BusAxis::ask(double value, std::int64_t now_ns) {
  host_->ask(setup_.demand, setup_.device_per_asked * value, frames_);
  send(now_ns, value);
}

void BusAxis::stop(std::int64_t now_ns) {
  host_->stop(frames_);
  send(now_ns, AxisMoment::kNotTold);
}

void BusAxis::send(std::int64_t now_ns, double value) {
  for (const BusFrame& frame : frames_) {
    wire_->write(frame);
    log(now_ns, frame);
  }
  frames_.clear();
  if (!host_->answers_each()) open_.clear();
  open_.push_back({now_ns, value});
}

void BusAxis::read(std::int64_t now_ns, std::vector<AxisMoment>& out) {
  BusFrame frame;
  while (wire_->read(frame)) {
    log(now_ns, frame);
    if (!host_->hear(frame) || open_.empty()) continue;
    const Question question = open_.front();
    open_.pop_front();
    late_ = open_.empty() ? 0 : late_ + 1;
    if (late_ >= kLate) open_.clear(), late_ = 0;
    const AxisState& s = host_->state();
    const double rad = 2.0 * std::numbers::pi / setup_.turns_per_output;
    AxisMoment& r = out.emplace_back();
    r.now_ns = now_ns;
    r.time_s = 0.5e-9 * static_cast<double>(question.asked_ns + now_ns);
    r.uncertain_s = 0.5e-9 * static_cast<double>(now_ns - question.asked_ns);
    r.value = question.value;
    r.position_rad = rad * s.turns;
    r.velocity_rad_s = rad * s.turns_s;
    r.current_A = setup_.current_per_told * s.q_current_A;
    r.bus_V = s.bus_V;
  }
}

void BusAxis::log(std::int64_t now_ns, const BusFrame& f) {
  fmt::format_to(std::back_inserter(log_), "({:.6f}) axis ", 1e-9 * static_cast<double>(now_ns));
  log_ += f.extended ? fmt::format("{:08X}#", f.id) : fmt::format("{:03X}#", f.id);
  if (f.fd) log_ += f.bitrate_switch ? "#1" : "#0";
  if (f.remote) log_ += 'R';
  for (const std::uint8_t byte : f.bytes()) fmt::format_to(std::back_inserter(log_), "{:02X}", byte);
  log_ += '\n';
}

}  // namespace omnihil
