#include "hil/serve/serve.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <ctime>
#include <exception>
#include <memory>
#include <numbers>
#include <stdexcept>

#include "firmware_iface/firmware_checks.h"
#include "hil/league/league_sync.h"
#include "hil/loop/clock.h"
#include "hil/recording/recording_header.h"
#include "hil/recording/recording_writer.h"
#include "hil/recording/replay.h"
#include "hil/serve/packet_feed.h"
#include "hil/serve/serve_port.h"
#include "hil/serve/serve_signals.h"
#include "hil/serve/status_printer.h"
#include "hil/text/merged_lines.h"
#include "hil/variables/variable_watch.h"
#include "hil/wire/open_wire.h"
#include "protocols/radio_format.h"

namespace omnihil {
namespace {

constexpr std::int64_t kStatusEvery_ns = 50'000'000;  // of wall time
constexpr int kSyncWait_ms = 100;                     // a signal is seen within it
constexpr int kFifoPriority = 50;                     // below the kernel's own threads at 99, above all else

void complain(const std::string& what) { std::fprintf(stderr, "omnihil serve: %s\n", what.c_str()); }

// "2026-03-01T12:34:56Z"
std::string wall_time_text() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  ::gmtime_r(&now, &parts);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text.data();
}

LinePace pace_of(const Carrier& carrier, const ServeOptions& options) {
  if (!options.pacing) return {};
  if (options.baud) return {*options.baud, 10};
  return carrier_pace(carrier);
}

std::string carrier_words(const Carrier& carrier, const LinePace& pace) {
  constexpr std::string_view kNames[] = {"USB CDC", "UART", "UDP", "SPI", "CAN"};
  const std::string_view name = kNames[static_cast<std::size_t>(carrier.kind)];
  if (pace.baud == 0) return fmt::format("{}, not paced", name);
  return fmt::format("{}, paced at {} baud", name, pace.baud);
}

// A robot that fell is said once, when it happens.
class TipWatch : public SessionObserver {
 public:
  explicit TipWatch(const Session& session) : session_(session) {}
  void world(std::int64_t, const World& world) override {
    for (const WorldEvent& event : world.events()) {
      if (event.kind != WorldEventKind::kTip) continue;
      const double time_s = 1e-9 * static_cast<double>(event.now_ns);
      const int robot = session_.robot_key(event.robot);
      complain(fmt::format("at {:.3f} s robot {} tips over: {:.0f} degrees", time_s, robot,
                           event.size * 180.0 / std::numbers::pi));
    }
  }

 private:
  const Session& session_;
};

class Bench {
 public:
  Bench(SessionConfig config, const Session::FirmwareMaker& make_firmware, const ServeOptions& options,
        const Session::FirmwareMaker& opponents_firmware)
      : options_(options), session_(std::move(config), make_firmware, opponents_firmware) {
    if (options.watch.empty() && options.set.empty()) return;
    variables_ = std::make_unique<VariableWatch>(options.firmware_file, options.watch, options.set, session_);
    session_.set_watch(variables_.get());
  }

  ServeEnd run(RecordingHeader header);

 private:
  bool open(RecordingHeader header);
  bool open_opponents();
  bool open_league();
  bool open_recording(RecordingHeader header);
  bool open_capture(std::uint64_t epoch_ms);
  void say_ready() const;
  ServeEnd loop();
  bool step();
  void forgive(std::int64_t stood_ns);
  void note_failures();
  ServeStatus status() const;
  void finish_recording();

  const ServeOptions& options_;
  Session session_;
  std::unique_ptr<VariableWatch> variables_;  // null: nobody looks at any
  StopSignals stop_;
  std::unique_ptr<ByteWire> wire_;
  std::unique_ptr<HostPort> port_;
  std::unique_ptr<ByteWire> opponents_wire_;  // null: the other team has no dongle
  std::unique_ptr<HostPort> opponents_port_;
  std::unique_ptr<RecordingWriter> writer_;
  std::unique_ptr<PacketFeed> feed_;
  std::unique_ptr<LeagueHost> league_;
  TipWatch tips_{session_};
  ObserverList observers_{{&tips_}};
  LeagueSync sync_;
  std::unique_ptr<Clock> clock_;
  std::string model_;  // as the user named it
  LinePace pace_;
  std::int64_t start_ns_ = 0;
  std::vector<bool> failed_;  // per robot: its firmware answers no more, and that was said
  std::vector<std::uint8_t> host_;
  std::vector<std::uint8_t> answer_;
  std::vector<std::uint8_t> opponents_host_, opponents_answer_;
};

bool Bench::open(RecordingHeader header) {
  pace_ = pace_of(find_radio_format(session_.config().radio_format)->carrier, options_);
  WireQuery usual{{"listen", "1"}};  // the host comes to us
  if (pace_.baud > 0) usual.emplace_back("baud", std::to_string(pace_.baud));
  WireProblem problem;
  wire_ = open_byte_wire(read_wire_url(options_.device, kServeDevice), usual, problem);
  if (!wire_) {
    complain(problem.text());
    return false;
  }
  port_ = std::make_unique<HostPort>(*wire_, pace_, HostPortOptions{});
  if (options_.fifo) {
    const std::string refused = become_realtime(kFifoPriority);
    if (!refused.empty()) {
      complain("--fifo: " + refused);
      return false;
    }
  }
  session_.set_observer(&observers_);
  return open_opponents() && open_league() && open_capture(header.epoch_ms) &&
         open_recording(std::move(header));
}

bool Bench::open_opponents() {
  if (options_.opponents_device.empty()) return true;
  WireQuery usual{{"listen", "1"}};
  if (pace_.baud > 0) usual.emplace_back("baud", std::to_string(pace_.baud));
  WireProblem problem;
  opponents_wire_ = open_byte_wire(read_wire_url(options_.opponents_device, kServeDevice), usual, problem);
  if (!opponents_wire_) {
    complain(problem.text());
    return false;
  }
  opponents_port_ = std::make_unique<HostPort>(*opponents_wire_, pace_, HostPortOptions{});
  return true;
}

bool Bench::open_league() {
  if (!options_.league) return true;
  std::string error;
  league_ = LeagueHost::open(*options_.league, session_.config(), error);
  if (!league_) {
    complain("league: " + error);
    return false;
  }
  observers_.add(league_.get());
  if (options_.league_sync_port == 0 ||
      sync_.listen(options_.league->address, options_.league_sync_port, error))
    return true;
  complain("league: " + error);
  return false;
}

bool Bench::open_capture(std::uint64_t epoch_ms) {
  if (options_.capture.empty()) return true;
  std::error_code error;
  feed_ =
      PacketFeed::open(options_.capture, *find_radio_format(session_.config().radio_format), epoch_ms, error);
  if (!feed_) {
    complain("--capture " + options_.capture + ": " + error.message());
    return false;
  }
  observers_.add(feed_.get());
  return true;
}

bool Bench::open_recording(RecordingHeader header) {
  if (options_.record.empty()) return true;
  std::error_code error;
  header.firmware = session_.firmware(0).name();
  if (variables_) header.watched = variables_->names();
  writer_ = RecordingWriter::open(options_.record, std::move(header), error, complain);
  if (!writer_) {
    complain("recording " + options_.record + ": " + error.message());
    return false;
  }
  observers_.add(writer_.get());
  *options_.record_console = [this](std::uint32_t robot, int board, const std::string& port,
                                    const std::string& line) {
    writer_->console_line(session_.now_ns(), static_cast<int>(robot), board, port, line);
  };
  return true;
}

void Bench::say_ready() const {
  const SessionConfig& config = session_.config();
  const std::string device(looks_like_wire(options_.device) ? wire_->name() : options_.device);
  fmt::print("device {} ready: {} ({}), robots {} of model {}, team {}, {}, {}\n", device,
             config.radio_format, carrier_words(find_radio_format(config.radio_format)->carrier, pace_),
             fmt::join(config.robot_ids, " "), model_, config.team == Team::kBlue ? "blue" : "yellow",
             to_string(config.plant.physics), options_.real_time ? "real time" : "free-running");
  if (!config.opponents.robot_ids.empty())
    fmt::print("opponents {}{}\n", fmt::join(config.opponents.robot_ids, " "),
               opponents_wire_ ? " at device " + std::string(opponents_wire_->name()) : "");
  if (league_) fmt::print("league {}\n", league_->ports());
  if (options_.league_sync_port > 0)
    fmt::print("league synchronous protocol: TCP {}:{}; time goes on by its requests alone\n",
               options_.league->address, sync_.port());
  if (!options_.quiet) fmt::print("{}", options_.load);
  std::fflush(stdout);
}

ServeStatus Bench::status() const {
  ServeStatus s;
  s.now_ns = session_.now_ns();
  s.wall_ns = monotonic_now_ns() - start_ns_;
  s.steps = static_cast<std::uint64_t>(s.now_ns / session_.config().step_ns);
  s.host_present = port_->host_present();
  s.from_host = session_.link().from_host();
  s.from_robots = session_.link().from_robots();
  s.gains_refused = session_.gains_refused();
  s.air = session_.air();
  for (std::size_t i = 0; i < static_cast<std::size_t>(session_.robot_count()); ++i) {
    const auto* host = dynamic_cast<const CheckedFirmware*>(&session_.firmware(static_cast<int>(i)));
    if (host != nullptr) s.firmware_faults += host->faults().total();
  }
  s.port = port_->counts();
  take_clock(clock_->report(), s);
  const RobotTruth truth = session_.plant().truth(0);
  if (variables_) s.variables = variables_->text(0);
  s.robot_id = session_.config().robot_ids[0];
  std::copy_n(truth.omega_wheel_rad_s.begin(), kWheels, s.omega_wheel_rad_s.begin());
  s.x_m = truth.x_m;
  s.y_m = truth.y_m;
  s.yaw_rad = truth.yaw_rad;
  return s;
}

// A firmware that is no more takes its own robot out, not the bench.
void Bench::note_failures() {
  failed_.resize(static_cast<std::size_t>(session_.robot_count()));
  for (std::size_t i = 0; i < failed_.size(); ++i) {
    const std::string_view failure = session_.firmware(static_cast<int>(i)).failure();
    if (failed_[i] || failure.empty()) continue;
    failed_[i] = true;
    complain(fmt::format("robot {}: firmware {}; its wheels coast from here on",
                         session_.robot_key(static_cast<int>(i)), failure));
  }
}

// One turn of the loop; false when the device failed.
bool Bench::step() {
  std::error_code error = port_->receive(session_.now_ns(), host_);
  answer_.clear();
  opponents_host_.clear();
  opponents_answer_.clear();
  if (!error && opponents_port_) error = opponents_port_->receive(session_.now_ns(), opponents_host_);
  if (league_) league_->before_step(session_);
  session_.step(host_, answer_, opponents_host_, opponents_answer_);
  // The answer first: whoever waits for it does not wait for what the cameras see.
  if (!error) error = port_->send(session_.now_ns(), answer_);
  if (!error && opponents_port_) error = opponents_port_->send(session_.now_ns(), opponents_answer_);
  if (league_) league_->after_step(session_);
  if (feed_) feed_->turn();
  note_failures();
  if (port_->take_host_closed()) session_.host_closed();
  if (error) complain("device " + options_.device + ": " + error.message());
  return !error;
}

// Time that the bench stood for the debugger is nobody's lateness.
void Bench::forgive(std::int64_t stood_ns) {
  clock_->forgive(stood_ns);
  start_ns_ += stood_ns;
}

ServeEnd Bench::loop() {
  std::unique_ptr<StatusPrinter> printer;
  if (!options_.quiet) printer = std::make_unique<StatusPrinter>(stdout);
  std::int64_t next_status_ns = start_ns_ + kStatusEvery_ns;
  const bool in_sync = options_.league_sync_port > 0;
  bool device_good = true;
  while (!stop_.requested() && (options_.duration_ns == 0 || session_.now_ns() < options_.duration_ns)) {
    if (in_sync) {
      sync_.serve_one(
          session_, *league_, [&] { device_good = step() && device_good; }, kSyncWait_ms);
    } else if (clock_->wait()) {
      device_good = step();
    } else {
      continue;
    }
    if (options_.gdb != nullptr) forgive(options_.gdb->take_stood_ns());
    if (!device_good) return ServeEnd::kIo;
    if (options_.strict && clock_->report().slips > 0) {
      complain("--strict: this computer could not keep up with real time");
      return ServeEnd::kLate;
    }
    if (!printer) continue;
    const std::int64_t wall_ns = monotonic_now_ns();
    if (wall_ns < next_status_ns) continue;
    next_status_ns = wall_ns + kStatusEvery_ns;
    printer->post(status());
  }
  return ServeEnd::kDone;
}

void Bench::finish_recording() {
  if (!writer_) return;
  *options_.record_console = {};
  session_.set_observer(nullptr);
  const ServeStatus s = status();
  RecordingEnd end{.now_ns = s.now_ns, .wall_s = static_cast<double>(s.wall_ns) * 1e-9, .counters = {}};
  const auto add = [&end](const std::string& who, const PacketCounts& counts) {
    end.counters.emplace_back(who + " packets good", counts.good);
    for (std::size_t i = 0; i < counts.bad.size(); ++i) {
      if (counts.bad[i] == 0) continue;
      end.counters.emplace_back(fmt::format("{} refused: {}", who, to_string(static_cast<PacketError>(i))),
                                counts.bad[i]);
    }
  };
  add("host", s.from_host);
  add("robot", s.from_robots);
  end.counters.emplace_back("slipped ns", static_cast<std::uint64_t>(s.slipped_ns));
  writer_->finish(end);
}

ServeEnd Bench::run(RecordingHeader header) {
  model_ = header.robot_model;
  header.started = wall_time_text();
  if (!open(std::move(header))) return ServeEnd::kIo;
  start_ns_ = monotonic_now_ns();
  if (options_.real_time) {
    clock_ = std::make_unique<RealClock>(RealClockOptions{
        .step_ns = session_.config().step_ns, .start_ns = options_.start_ns, .spin_ns = options_.spin_ns});
  } else {
    clock_ = std::make_unique<FreeClock>();
  }
  say_ready();
  for (const StartPose& start : options_.starts) {
    for (int i = 0; i < session_.robot_count(); ++i)
      if (session_.robot_key(i) == start.key) session_.set_pose(i, start.x_m, start.y_m, start.yaw_rad);
  }
  ServeEnd end = ServeEnd::kDone;
  try {
    end = loop();
  } catch (const std::exception& error) {
    complain(error.what());
    end = ServeEnd::kDiverged;
  }
  finish_recording();
  if (options_.gdb != nullptr) options_.gdb->end(0);
  const bool firmware_failed = std::find(failed_.begin(), failed_.end(), true) != failed_.end();
  if (end == ServeEnd::kDone && firmware_failed) end = ServeEnd::kFirmware;
  if (end == ServeEnd::kDone && writer_ && writer_->error()) end = ServeEnd::kIo;
  if (!options_.quiet) {
    fmt::print("{}", final_report(status()));
    std::vector<LinesOf> robots;
    for (int i = 0; i < session_.robot_count(); ++i)
      robots.push_back({session_.robot_key(i), session_.firmware(i).report()});
    for (const std::string& line : merge_lines("robot", "robots", robots)) fmt::print("  {}\n", line);
    if (league_ && league_->counts().grsim_packets > 0) {
      const LeagueCounts& league = league_->counts();
      fmt::print("  grSim            {} packets, {} errors{}\n", league.grsim_packets, league.grsim_errors,
                 league.grsim_error.empty() ? "" : ", the last: " + league.grsim_error);
    }
    if (writer_ && !writer_->error()) {
      fmt::print("  recording        {} ({} bytes)\n", options_.record, writer_->bytes_written());
    }
    std::fflush(stdout);
  }
  return end;
}

}  // namespace

ServeEnd serve(SessionConfig config, const Session::FirmwareMaker& make_firmware, RecordingHeader header,
               const ServeOptions& options, const Session::FirmwareMaker& opponents_firmware) {
  Bench bench(std::move(config), make_firmware, options, opponents_firmware);
  if (options.gdb != nullptr && !options.gdb->problem().empty())
    throw std::invalid_argument("--gdb: " + options.gdb->problem());
  return bench.run(std::move(header));
}

}  // namespace omnihil
