#include "hil/firmware/remote_firmware.h"

#include <fmt/format.h>

#include <algorithm>

#include "hil/loop/clock.h"
#include "hil/loop/session_checks.h"
#include "hil/wire/can_byte_wire.h"
#include "hil/wire/open_wire.h"

namespace omnihil {
namespace {

constexpr const char* kUsualBaud = "921600";            // 1 kHz of both frames takes 640 kbit/s
constexpr std::size_t kQueue_bytes = 4096;              // what a stopped line may pile up
constexpr std::int64_t kDriveTimeout_ns = 50'000'000;   // real time
constexpr std::int64_t kReplyTimeout_ns = 100'000'000;  // lock-step
constexpr int kMaxMissedInARow = 20;                    // lock-step: 2 s of wall time

// Frames take their time on CAN and are old when they wait: what it does not take now is lost.
BufferedWire open_line(const WireUrl& url) {
  const bool frames = find_wire_kind(url.scheme)->open_frames != nullptr;
  WireProblem problem;
  std::unique_ptr<ByteWire> wire;
  if (frames) {
    std::unique_ptr<FrameWire> can = open_frame_wire(url, {}, problem);
    const std::string* fd = url.find("fd");
    if (can) wire = make_can_byte_wire(std::move(can), fd != nullptr && *fd == "1");
  } else {
    wire = open_byte_wire(url, {{"baud", kUsualBaud}}, problem);
  }
  if (!wire) throw_problems({"firmware: " + problem.text()});
  return {std::move(wire), frames ? 0 : kQueue_bytes};
}

double ms(std::int64_t ns) { return static_cast<double>(ns) * 1e-6; }

}  // namespace

Session::FirmwareMaker remote_firmware(const RemoteChoice& choice, const SessionConfig& session) {
  std::vector<std::string> problems;
  for (const std::string& problem : wire_problems(read_wire_url(choice.url), WireForm::kEither)) {
    problems.push_back("firmware " + problem);
  }
  if (session.robot_ids.size() > 1 && choice.url.find("{id}") == std::string::npos) {
    problems.push_back(
        fmt::format("firmware {}: one board for {} robots; put {{id}} where the robot's number goes, "
                    "or run one robot",
                    choice.url, session.robot_ids.size()));
  }
  throw_problems(problems);
  return [choice](const RobotConfig& config) -> std::unique_ptr<Firmware> {
    const std::string device = with_number(choice.url, "{id}", config.robot_id);
    RemoteLink link(open_line(read_wire_url(device)));
    std::string problem;
    RemoteHello hello;
    if (!link.hello(config, hello, problem))
      throw_problems({fmt::format("firmware {}: {}", device, problem)});
    return std::make_unique<RemoteFirmware>(std::move(link), std::move(hello), choice.lock_step);
  };
}

RemoteFirmware::RemoteFirmware(RemoteLink link, RemoteHello hello, bool lock_step)
    : link_(std::move(link)), hello_(std::move(hello)), lock_step_(lock_step) {}

std::size_t RemoteFirmware::radio_transmit(std::span<std::uint8_t> out) {
  if (link_.radio().empty()) return 0;
  const std::vector<std::uint8_t> frame = std::move(link_.radio().front());
  link_.radio().erase(link_.radio().begin());
  const std::size_t n = std::min(frame.size(), out.size());
  std::copy_n(frame.begin(), n, out.begin());
  return n;
}

// Whether the drive that is there may move the robot in this period.
bool RemoteFirmware::fresh() {
  const std::uint64_t number = link_.sensors_number();
  if (!lock_step_) {
    link_.poll();
    // At the call the sensors before these had a whole period to be answered.
    if (number > 0 && link_.drive_answers() < number) ++missed_;
    return link_.drive_answers() > 0 && monotonic_now_ns() - link_.drive_at_ns() < kDriveTimeout_ns;
  }
  const std::int64_t end_ns = monotonic_now_ns() + kReplyTimeout_ns;
  for (link_.poll(); link_.drive_answers() != number && link_.failure().empty(); link_.poll()) {
    const std::int64_t left_ns = end_ns - monotonic_now_ns();
    if (left_ns <= 0) break;
    link_.wait(left_ns);
  }
  const bool answered = link_.drive_answers() == number;
  missed_in_a_row_ = answered ? 0 : missed_in_a_row_ + 1;
  if (!answered) ++missed_;
  return answered;
}

RobotDrive RemoteFirmware::tick(const RobotSensors& sensors) {
  if (!failure_.empty()) return {};
  if (lock_step_) link_.send_sensors(sensors);
  const bool driving = fresh();
  if (!lock_step_) link_.send_sensors(sensors);
  if (!driving && !timed_out_) ++timeouts_;
  timed_out_ = !driving;
  if (!link_.failure().empty()) failure_ = "is gone: " + std::string(link_.failure());
  if (lock_step_ && missed_in_a_row_ >= kMaxMissedInARow) {
    failure_ = fmt::format("\"{}\" fell silent: {} control periods in a row without an answer", hello_.name,
                           kMaxMissedInARow);
  }
  if (!driving || !failure_.empty()) return {};
  RobotDrive drive = link_.drive();
  if (kicked_for_ == link_.drive_answers()) drive.kick = OMNIHIL_KICK_NONE;  // an old drive kicks once
  kicked_for_ = link_.drive_answers();
  feedback_.now_us = sensors.now_us;
  feedback_.battery_V = sensors.bus_voltage_V;
  std::copy_n(drive.duty_ratio, kWheels, feedback_.duty_ratio);
  return drive;
}

std::vector<std::string> RemoteFirmware::report() const {
  const RemoteCounts& c = link_.counts();
  const omnihil_remote_decoder& d = link_.decoder();
  const LatenessHistogram& trip = link_.round_trip();
  std::vector<std::string> lines;
  lines.push_back(
      fmt::format("board \"{}\": {} sensor frames sent, {} answered, {} without an answer, {} dropped at a "
                  "full line",
                  hello_.name, c.sensors_sent, c.drives, c.sensors_sent - c.drives, c.line_full));
  lines.push_back(fmt::format(
      "round trip p50 {:.3f} ms, p99 {:.3f} ms, max {:.3f} ms; periods on an older drive or "
      "none {}; let go by time-out {}",
      ms(trip.quantile_ns(0.5)), ms(trip.quantile_ns(0.99)), ms(trip.max_ns()), missed_, timeouts_));
  if (link_.board_time().count() > 0) {
    lines.push_back(fmt::format("the board's own time p50 {:.3f} ms, max {:.3f} ms",
                                ms(link_.board_time().quantile_ns(0.5)), ms(link_.board_time().max_ns())));
  }
  lines.push_back(fmt::format(
      "refused: checksum {}, stuffing {}, too long {}, too short {}, payload {}, type {}, out "
      "of order {}",
      d.bad_crc, d.bad_cobs, d.too_long, d.too_short, c.bad_payload, c.unknown_type, c.out_of_order));
  return lines;
}

}  // namespace omnihil
