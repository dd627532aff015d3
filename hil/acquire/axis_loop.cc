#include "hil/acquire/axis_loop.h"

#include <poll.h>

#include <algorithm>
#include <cmath>
#include <ctime>

#include "hil/acquire/axis_watch.h"

namespace omnihil {
namespace {

constexpr std::int64_t kLongestWait_ns = 20'000'000;  // how late a limit or a signal may be seen

// The stop on any way out of a run that has not said it itself.
class StopOnLeave {
 public:
  explicit StopOnLeave(AxisEnd& end) : end_(end) {}
  ~StopOnLeave() {
    for (int n = 0; armed_ && n < RunDriver::kStopPackets; ++n) end_.stop(0);
  }
  StopOnLeave(const StopOnLeave&) = delete;
  StopOnLeave& operator=(const StopOnLeave&) = delete;
  void disarm() { armed_ = false; }

 private:
  AxisEnd& end_;
  bool armed_ = true;
};

// Of a period: a sample that may lie further from its time shows a motion that was not. A choice.
constexpr double kMostUncertain = 0.5;

AxisMoment demand_alone(const AxisMoment& r) {
  AxisMoment out{.now_ns = r.now_ns, .time_s = r.time_s - r.uncertain_s};
  out.value = r.value;
  return out;
}

// A held signal at the instants of its steps, as one reads it that is interpolated linearly: the mean of both sides. With the value
// behind each step alone it would lead by half a row.
std::vector<double> at_steps(const std::vector<double>& held) {
  std::vector<double> out = held;
  for (std::size_t k = 1; k < held.size(); ++k) {
    if (std::isfinite(held[k - 1]) && std::isfinite(held[k])) out[k] = 0.5 * (held[k - 1] + held[k]);
  }
  return out;
}

struct Column {
  const char* name;
  double AxisMoment::*value;
};
constexpr Column kColumns[] = {{"encoder", &AxisMoment::counts},
                               {"position", &AxisMoment::position_rad},
                               {"velocity", &AxisMoment::velocity_rad_s},
                               {"current", &AxisMoment::current_A},
                               {"bus", &AxisMoment::bus_V}};

}  // namespace

void AxisAcquirer::wait_until(std::int64_t until_ns) const {
  const std::int64_t left_ns = std::clamp<std::int64_t>(until_ns - now_ns(), 0, kLongestWait_ns);
  pollfd watched{end_.handle(), POLLIN, 0};
  const timespec most{0, left_ns};
  ::ppoll(&watched, watched.fd >= 0 ? 1 : 0, &most, nullptr);
}

AxisRunEnd AxisAcquirer::run(const PlanRun& run, const std::function<bool()>& stop) {
  AxisRunEnd done;
  AxisWatch watch(plan_.limits);
  RunDriver driver(plan_, run, watch, now_ns());
  StopOnLeave guard(end_);
  std::vector<AxisMoment> all;
  bool asked_to_stop = false;
  std::int64_t driven_to_ns = 0;
  while (driver.state() != RunState::kDone && done.problem.empty()) {
    if (!asked_to_stop && stop()) {
      asked_to_stop = true;
      driver.stop("stopped by the user");
    }
    const std::size_t before = all.size();
    end_.read(now_ns(), all);
    for (std::size_t k = before; k < all.size(); ++k) watch.told(all[k]);
    watch.trouble(end_.trouble());
    const std::int64_t now = now_ns(), due_ns = driver.next_ns();
    driver.look(now);
    if (const auto packet = driver.due(now)) {
      const std::int64_t at_ns = now_ns();
      if (packet->stop) {
        end_.stop(at_ns);
      } else {
        end_.ask(packet->value[0], at_ns);
        driven_to_ns = at_ns;
        ++done.asked;
        done.latest_s = std::max(done.latest_s, 1e-9 * static_cast<double>(at_ns - due_ns));
      }
    }
    if (const std::string lost = end_.lost(); !lost.empty()) {
      done.wire_lost = true;
      done.problem = std::string(end_.name()) + ": " + lost;
    }
    if (driver.state() != RunState::kDone) wait_until(driver.next_ns());
  }
  if (!done.wire_lost) guard.disarm();
  if (done.problem.empty()) done.problem = driver.problem();
  done.left_out = driver.left_out();
  done.packets = end_.take_log();
  const auto from_ns = driver.driving_from_ns() - static_cast<std::int64_t>(1e9 * kLead_s);
  // Behind the last demand only the answer to it.
  const std::int64_t to_ns = driven_to_ns + std::llround(1e9 / plan_.packets_Hz);
  for (const AxisMoment& r : all) {
    if (r.now_ns < from_ns || r.now_ns > to_ns) continue;
    done.samples.push_back(r);
    if (r.uncertain_s > kMostUncertain / plan_.packets_Hz) done.samples.back() = demand_alone(r);
  }
  while (!done.samples.empty() && !std::isfinite(done.samples.back().value)) done.samples.pop_back();
  return done;
}

RunRows axis_rows(const std::vector<AxisMoment>& samples, PlanDrive drive) {
  RunRows rows;
  if (samples.empty()) return rows;
  rows.start_s = samples.front().time_s;
  std::vector<const AxisMoment*> rising;  // a clock that was set, a sample that came twice
  for (const AxisMoment& r : samples) {
    if (rising.empty() || r.time_s > rising.back()->time_s + 1.5e-6) rising.push_back(&r);
  }
  for (const AxisMoment* r : rising) rows.time_s.push_back(r->time_s - rows.start_s);
  const auto add = [&](std::string name, double AxisMoment::*value) {
    std::vector<double> column;
    for (const AxisMoment* r : rising) column.push_back(r->*value);
    if (std::none_of(column.begin(), column.end(), [](double v) { return std::isfinite(v); })) return;
    rows.columns.push_back(std::move(name));
    rows.values.push_back(std::move(column));
  };
  add(std::string(plan_drive_word(drive)), &AxisMoment::value);
  if (drive == PlanDrive::kMotorTorque && !rows.values.empty())
    rows.values.front() = at_steps(rows.values.front());
  // Of counts the rest is made.
  const bool counted = std::isfinite(rising.front()->counts);
  for (const Column& c : kColumns) {
    const bool motion = c.value == &AxisMoment::position_rad || c.value == &AxisMoment::velocity_rad_s;
    if (!counted || !motion) add(c.name, c.value);
  }
  return rows;
}

}  // namespace omnihil
