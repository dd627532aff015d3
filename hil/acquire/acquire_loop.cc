#include "hil/acquire/acquire_loop.h"

#include <fmt/format.h>
#include <poll.h>

#include <algorithm>
#include <cmath>
#include <ctime>

#include "hil/league/robot_sights.h"
#include "hil/loop/radio_front.h"

namespace omnihil {
namespace {

constexpr std::size_t kBite_bytes = 4096;
constexpr std::int64_t kLongestWait_ns = 20'000'000;  // how late a limit or a signal may be seen

void log_bytes(std::string& text, std::int64_t now_ns, char way, std::span<const std::uint8_t> bytes) {
  fmt::format_to(std::back_inserter(text), "{:.6f} {} ", 1e-9 * static_cast<double>(now_ns), way);
  for (const std::uint8_t byte : bytes) fmt::format_to(std::back_inserter(text), "{:02x}", byte);
  text += '\n';
}

// Stop packets on any way out of a run that has not sent them itself.
class StopOnLeave {
 public:
  StopOnLeave(const AcquireEnds& ends, PlanDrive drive) : wire_(ends.wire) {
    SaidCommand said;
    CommandTo to = ends.to;
    to.set_up = true;
    if (say_planned(ends.format, to, drive, {}, 0.0, said)) bytes_ = std::move(said.bytes);
  }
  ~StopOnLeave() {
    std::error_code ignored;
    for (int n = 0; armed_ && n < RunDriver::kStopPackets; ++n) wire_.write(bytes_, ignored);
  }
  StopOnLeave(const StopOnLeave&) = delete;
  StopOnLeave& operator=(const StopOnLeave&) = delete;
  void disarm() { armed_ = false; }

 private:
  ByteWire& wire_;
  std::vector<std::uint8_t> bytes_;
  bool armed_ = true;
};

}  // namespace

bool say_planned(const RadioFormat& format, const CommandTo& to, PlanDrive drive,
                 const std::array<double, kWheels>& value, double yaw_rad, SaidCommand& out) {
  out = {};
  out.sent.value = value;
  const std::optional<RobotCommand> said =
      encode_towards(format, plan_command(drive, value), yaw_rad, to, out.bytes);
  if (said && (said->flags & OMNIHIL_COMMAND_FIELD_FRAME) != 0) {
    out.sent.value = {said->v_forward_m_s, said->v_left_m_s, said->omega_body_rad_s, 0.0};
    out.sent.in_field = true;
  }
  return said.has_value();
}

std::vector<std::string> plan_problems(const AcquirePlan& plan, const RadioFormat& format,
                                       const CommandTo& to) {
  std::vector<std::string> problems;
  SaidCommand said;
  if (!say_planned(format, to, plan.drive, {}, 0.0, said)) {
    problems.push_back(fmt::format("{} cannot ask a robot for {}", format.id, plan_drive_word(plan.drive)));
    return problems;
  }
  for (const PlanRun& run : plan.runs) {
    for (const PlanStep& step : run.steps) {
      if (say_planned(format, to, plan.drive, step.value, 0.0, said)) continue;
      problems.push_back(
          fmt::format("{}: {} cannot say what is asked at {:g} s", run.name, format.id, step.at_s));
      break;
    }
  }
  return problems;
}

Acquirer::Acquirer(const AcquireEnds& ends, const AcquirePlan& plan)
    : ends_(ends), plan_(plan), cutter_(ends.format), hears_(tells_anything(ends.format)) {}

void Acquirer::read_wire(std::int64_t now, RunEnd& end, LimitWatch& watch) {
  std::vector<std::uint8_t> bytes;
  if (const std::error_code error = ends_.wire.read(bytes, kBite_bytes)) {
    end.wire_lost = true;
    end.problem = fmt::format("{}: {}", ends_.wire.name(), error.message());
    return;
  }
  if (bytes.empty()) return;
  log_bytes(end.packets, now, '<', bytes);
  cutter_.push(bytes);
  while (const auto frame = cutter_.next()) {
    if (!frame->understood) {
      end.not_understood += frame->bytes.size();
      continue;
    }
    const auto told = telemetry_of(ends_.format, ends_.format.decode(frame->bytes).values);
    if (!told || (told->robot_id >= 0 && told->robot_id != ends_.to.robot_id)) continue;
    watch.told(now, *told);
    if (std::isfinite(told->yaw_rad)) told_yaw_rad_ = told->yaw_rad;
    end.log.told.push_back({now, *told});
  }
}

void Acquirer::read_vision(std::int64_t now, RunEnd& end, LimitWatch& watch) {
  if (ends_.vision == nullptr) return;
  std::string datagram;
  sockaddr_in from{};
  while (ends_.vision->receive(datagram, from)) {
    const std::optional<FrameTimes> times = frame_times(datagram);
    if (!times) continue;
    cameras_[times->camera].add(times->sent_s, 1e-9 * static_cast<double>(now));
    for (const RobotSight& s : robot_sights(datagram, ends_.to.team, ends_.to.robot_id)) {
      watch.seen(now, {s.x_m, s.y_m, s.yaw_rad});
      end.log.seen.push_back({s.camera, s.capture_s, s.x_m, s.y_m, s.yaw_rad});
    }
  }
}

void Acquirer::flush(RunEnd& end, RunDriver& driver) {
  std::error_code error;
  waiting_.flush(ends_.wire, error);
  if (!error) return;
  end.wire_lost = true;
  driver.stop(fmt::format("{}: {}", ends_.wire.name(), error.message()));
}

void Acquirer::send(const PlannedPacket& packet, std::int64_t due_ns, RunEnd& end, RunDriver& driver,
                    const LimitWatch& watch) {
  CommandTo to = ends_.to;
  to.tell_all = true;
  to.set_up = packet.stop;
  const double yaw_rad = std::isfinite(told_yaw_rad_) ? told_yaw_rad_
                         : watch.pose()               ? (*watch.pose())[2]
                                                      : NAN;
  SaidCommand said;
  if (!say_planned(ends_.format, to, plan_.drive, packet.value, yaw_rad, said)) {
    driver.stop(
        std::isfinite(yaw_rad)
            ? fmt::format("{} cannot say what is asked", ends_.format.id)
            : fmt::format("{} asks in the field's frame, and nothing tells the heading", ends_.format.id));
    if (!say_planned(ends_.format, to, plan_.drive, {}, 0.0, said)) return;
  }
  waiting_.append(said.bytes);
  flush(end, driver);
  said.sent.now_ns = now_ns();
  end.latest_s = std::max(end.latest_s, 1e-9 * static_cast<double>(said.sent.now_ns - due_ns));
  end.log.sent.push_back(said.sent);
  log_bytes(end.packets, said.sent.now_ns, '>', said.bytes);
}

void Acquirer::wait_until(std::int64_t until_ns) const {
  const std::int64_t left_ns = std::clamp<std::int64_t>(until_ns - now_ns(), 0, kLongestWait_ns);
  pollfd watched[2];
  nfds_t count = 0;
  if (ends_.wire.handle() >= 0) watched[count++] = {ends_.wire.handle(), POLLIN, 0};
  if (ends_.vision != nullptr) watched[count++] = {ends_.vision->handle(), POLLIN, 0};
  const timespec most{0, left_ns};
  ::ppoll(watched, count, &most, nullptr);
}

RunEnd Acquirer::run(const PlanRun& run, const std::function<bool()>& stop) {
  RunEnd end;
  LimitWatch watch(plan_.limits, {.hears = hears_, .sees = ends_.vision != nullptr});
  RunDriver driver(plan_, run, watch, now_ns());
  StopOnLeave guard(ends_, plan_.drive);
  bool asked = false;
  while (driver.state() != RunState::kDone && !end.wire_lost) {
    if (!asked && stop()) {
      asked = true;
      driver.stop("stopped by the user");
    }
    const std::int64_t now = now_ns();
    read_wire(now, end, watch);
    read_vision(now, end, watch);
    driver.look(now);
    const std::int64_t due_ns = std::max<std::int64_t>(driver.next_ns(), 1);
    if (const auto packet = driver.due(now)) send(*packet, due_ns == 1 ? now : due_ns, end, driver, watch);
    flush(end, driver);
    if (driver.state() != RunState::kDone) wait_until(driver.next_ns());
  }
  if (!end.wire_lost) guard.disarm();
  if (end.problem.empty()) end.problem = driver.problem();
  end.left_out = driver.left_out();
  end.log.driving_from_ns = driver.driving_from_ns();
  end.log.end_ns = now_ns();
  end.log.cameras = cameras_;
  return end;
}

}  // namespace omnihil
