#include "hil/scenario/scenario_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "firmware_iface/firmware_checks.h"
#include "hil/loop/session_checks.h"
#include "hil/loop/timed_faults.h"
#include "hil/scenario/scenario_rows.h"
#include "hil/variables/variable_watch.h"
#include "protocols/radio_format.h"

namespace omnihil {
namespace {

std::int64_t ns(double time_s) { return std::llround(time_s * 1e3) * 1'000'000; }

class Bench : public SessionObserver {
 public:
  Bench(const Scenario& scenario, const SessionConfig& config, const Session::FirmwareMaker& make_firmware,
        const ScenarioVariables& variables, ScenarioConsole* console)
      : scenario_(scenario),
        console_(console),
        geometry_(wheel_geometry(config.robots.at(0))),
        model_(config.robots.at(0)),
        robot_id_(config.robot_ids.at(0)),
        session_(config, make_firmware) {
    session_.set_observer(this);
    const RadioFormat* format = find_radio_format(config.radio_format);
    const bool decodes = session_.firmware(0).radio_format() == config.radio_format;
    if (decodes && scenario.path != CommandPath::kHal) format_ = format;
    if (scenario.path == CommandPath::kRadio && format_ == nullptr) {
      throw_problems(
          {fmt::format("{}: commands = \"radio\": firmware \"{}\" decodes no radio format that a "
                       "host's commands can be written in",
                       scenario.file, session_.firmware(0).name())});
    }
    look_at(variables);
    listen();
    break_chip();
  }

  ScenarioRun run() {
    run_.firmware = session_.firmware(0).name();
    marked_ = session_.world().save();
    const std::int64_t end_ns = ns(scenario_.duration_s);
    try {
      while (session_.now_ns() < end_ns && (run_.failure.empty() || scenario_.goes_on)) {
        begin_and_end_steps();
        session_.step(host_packet(), answer_);
        answer_.clear();
        note_failure();
      }
    } catch (const std::runtime_error& error) {
      run_.failure = error.what();
    }
    run_.commands = format_ != nullptr && !past_radio_
                        ? fmt::format("commands by radio {}", session_.config().radio_format)
                        : std::string("commands past the radio");
    if (const FirmwareChip* const chip = session_.firmware_chip(0)) {
      run_.ram_in_use = chip->ram_in_use();
      run_.flash_in_use = chip->flash_in_use();
      run_.interrupts_in_use = chip->interrupts_in_use();
    }
    if (console_ != nullptr)
      run_.console.assign(console_->keeper.lines().begin(), console_->keeper.lines().end());
    return std::move(run_);
  }

  void world(std::int64_t, const World& world) override {
    for (const WorldEvent& event : world.events()) {
      sample_.goals += event.kind == WorldEventKind::kGoal;
      sample_.kicks += event.kind == WorldEventKind::kKick;
      sample_.ball_touches += event.kind == WorldEventKind::kBallTouch;
      sample_.robot_touches += event.kind == WorldEventKind::kRobotsTouch;
      sample_.tips += event.kind == WorldEventKind::kTip;
    }
  }

  void robot_tick(std::int64_t at_ns, const RobotSample& robot) override {
    if (robot.robot_id != robot_id_) return;  // of an opponent
    if (console_ != nullptr) console_->keeper.robot_tick(at_ns, robot);
    sample_.robot = robot;
    if (const BallState* const ball = session_.world().ball()) {
      sample_.ball_m = ball->position;
      sample_.ball_m_s = ball->velocity;
    }
    // a control period that ran leaves its instant in the feedback; 0: this firmware does not tell
    if (robot.feedback.now_us != 0 && robot.feedback.now_us != robot.sensors.now_us) ++stale_periods_;
    sample_.missed_periods =
        static_cast<double>(stale_periods_ + session_.firmware(0).missed_control_periods());
    if (const auto* checked = dynamic_cast<const CheckedFirmware*>(&session_.firmware(0))) {
      sample_.refused_requests = static_cast<double>(checked->faults().total());
    }
    run_.trace.add(static_cast<double>(at_ns) * 1e-9, sample_);
  }

 private:
  // What the scenario names and what is asked for besides.
  void look_at(const ScenarioVariables& wanted) {
    std::vector<std::string> watch, problems;
    for (const ScenarioCheck& check : scenario_.checks) {
      if (check.signal.starts_with(kVariablePrefix))
        watch.push_back(check.signal.substr(kVariablePrefix.size()));
    }
    const std::size_t of_checks = watch.size();
    watch.insert(watch.end(), wanted.watch.begin(), wanted.watch.end());
    const auto sets = [](const ScenarioStep& step) { return step.kind == StepKind::kSet; };
    if (watch.empty() && wanted.set.empty() && std::ranges::none_of(scenario_.steps, sets)) return;
    variables_ = std::make_unique<VariableWatch>(wanted.file, watch, wanted.set, session_);
    for (std::size_t i = 0; i < of_checks; ++i) {
      if (std::ranges::find(variables_->names(), watch[i]) == variables_->names().end())
        problems.push_back(fmt::format("{}: variable {}: is no single value", scenario_.file, watch[i]));
    }
    for (const ScenarioStep& step : scenario_.steps) {
      if (!sets(step)) continue;
      const std::string problem = variables_->set_problem(step.variable, step.value);
      if (!problem.empty()) problems.push_back(fmt::format("{}:{}: {}", scenario_.file, step.line, problem));
    }
    throw_problems(problems);
    session_.set_watch(variables_.get());
    run_.trace = ScenarioTrace(variables_->names());
  }

  // A check of what is never said would pass where nobody can say anything, and what is typed would be lost unseen.
  void listen() {
    std::vector<std::string> problems;
    const auto need = [&](int line, std::string_view word, std::string_view what) {
      problems.push_back(
          fmt::format("{}:{}: {}: needed: an image on a board with a console{}, [[port]] with console = true",
                      scenario_.file, line, word, what));
    };
    for (const ScenarioCheck& check : scenario_.checks) {
      if (of_console(check.kind) && (console_ == nullptr || !console_->there))
        need(check.line, row_of(check.kind).word, "");
    }
    for (const ScenarioStep& step : scenario_.steps) {
      if (step.kind == StepKind::kType && (console_ == nullptr || !console_->reads))
        need(step.line, row_of(step.kind).word, " that reads (a serial port or RTT)");
    }
    throw_problems(problems);
  }

  // All of them are given to the chip at once: it knows their instants better.
  void break_chip() {
    std::vector<std::string> problems;
    for (const ScenarioStep& step : scenario_.steps) {
      if (step.kind != StepKind::kChip) continue;
      FirmwareChip* const chip = session_.firmware_chip(0);
      const std::string problem =
          chip != nullptr ? chip->schedule(step.chip) : "needed: an image on an emulated ARM board";
      if (!problem.empty())
        problems.push_back(fmt::format("{}:{}: {}: {}", scenario_.file, step.line,
                                       chip_fault_word(step.chip.kind), problem));
    }
    throw_problems(problems);
  }

  void note_failure() {
    const std::string_view failure = session_.firmware(0).failure();
    if (failure.empty()) return;
    if (!scenario_.goes_on) run_.failure = failure;
    run_.firmware_failed = true;
  }

  void begin_and_end_steps() {
    const std::int64_t now_ns = session_.now_ns();
    RobotFaults faults;
    if (scenario_.stand) std::fill_n(faults.lifted.begin(), kWheels, true);
    silent_ = false;
    for (const ScenarioStep& step : scenario_.steps) {
      if (at_an_instant(step.kind)) {
        if (ns(step.at_s) == now_ns) begin(step);
      } else if (ns(step.at_s) <= now_ns && now_ns < ns(step.until_s)) {
        apply(step, faults);
      }
    }
    if (faults != session_.plant().faults(0)) session_.set_faults(0, faults);
  }

  static bool at_an_instant(StepKind kind) {
    return kind == StepKind::kCommand || kind == StepKind::kBall || kind == StepKind::kRobotAt ||
           kind == StepKind::kOpponentAt || kind == StepKind::kMark || kind == StepKind::kRewind ||
           kind == StepKind::kSet || kind == StepKind::kType || kind == StepKind::kChip;
  }

  void begin(const ScenarioStep& step) {
    const double radius_m = session_.world().options().ball.radius_m;
    switch (step.kind) {
      case StepKind::kCommand:
        take_command(step.of_top_speed ? at_top_ratios(step.command) : step.command);
        break;
      case StepKind::kBall:
        session_.put_ball({step.x_m, step.y_m, radius_m + step.z_m},
                          {step.v_x_m_s, step.v_y_m_s, step.v_z_m_s});
        break;
      case StepKind::kRobotAt:
        session_.set_pose(0, step.x_m, step.y_m, step.yaw_rad);
        break;
      case StepKind::kOpponentAt:
        session_.set_pose(1 + step.opponent, step.x_m, step.y_m, step.yaw_rad);
        break;
      case StepKind::kMark:
        marked_ = session_.world().save();
        break;
      case StepKind::kRewind:
        session_.set_world(marked_);
        break;
      case StepKind::kSet:
        variables_->set(0, step.variable, step.value);
        break;
      case StepKind::kType:
        console_->typed += step.typed;
        break;
      default:
        break;
    }
  }

  void apply(const ScenarioStep& step, RobotFaults& faults) {
    if (step.kind == StepKind::kRadioSilence) silent_ = true;
    join_faults(faults, faults_of(step));
  }

  // At which the back-EMF meets the supply.
  double idle_wheel_rad_s() const {
    return model_.bus_voltage_V / model_.motor.torque_constant_Nm_per_A / model_.gear_ratio;
  }

  RobotCommand at_top_ratios(RobotCommand command) const {
    for (double& omega : command.omega_wheel_rad_s)
      omega *= idle_wheel_rad_s() * model_.motor.duty_limit_ratio;
    return command;
  }

  // What the command means for body and wheels, eq. (5). A duty: the speed at which it meets the back-EMF.
  void take_command(const RobotCommand& command) {
    command_ = command;
    sample_.commanded = true;
    next_packet_ns_ = session_.now_ns();
    auto& wheels = sample_.wanted_wheel_rad_s;
    if (command.mode == OMNIHIL_MODE_BODY_VELOCITY) {
      sample_.wanted_body = {command.v_forward_m_s, command.v_left_m_s, command.omega_body_rad_s};
      wheels = wheel_speeds(geometry_, sample_.wanted_body);
      return;
    }
    const double idle_rad_s = idle_wheel_rad_s();
    for (std::size_t w = 0; w < kWheels; ++w) {
      wheels[w] = command.mode == OMNIHIL_MODE_WHEEL_SPEED  ? command.omega_wheel_rad_s[w]
                  : command.mode == OMNIHIL_MODE_WHEEL_DUTY ? command.duty_ratio[w] * idle_rad_s
                                                            : 0.0;
    }
    sample_.wanted_body = body_velocity(geometry_, wheels);
  }

  // A format without wheel speeds: the body velocity that asks for just these, if there is one.
  RobotCommand as_body_velocity(const RobotCommand& command) const {
    if (command.mode != OMNIHIL_MODE_WHEEL_SPEED) return command;
    constexpr double kSame_rad_s = 1e-6;
    const PerWheel<double> back = wheel_speeds(geometry_, sample_.wanted_body);
    for (std::size_t w = 0; w < kWheels; ++w) {
      if (std::abs(back[w] - command.omega_wheel_rad_s[w]) > kSame_rad_s) return command;
    }
    RobotCommand body{};
    body.mode = OMNIHIL_MODE_BODY_VELOCITY;
    body.v_forward_m_s = sample_.wanted_body.v_forward_m_s;
    body.v_left_m_s = sample_.wanted_body.v_left_m_s;
    body.omega_body_rad_s = sample_.wanted_body.omega_body_rad_s;
    return body;
  }

  // What the host writes now: due commands, by radio as bytes; else they go to the firmware at once.
  std::span<const std::uint8_t> host_packet() {
    packet_.clear();
    if (!sample_.commanded || session_.now_ns() < next_packet_ns_) return packet_;
    next_packet_ns_ += ns(scenario_.command_every_s);
    if (silent_) return packet_;
    if (format_ != nullptr) {
      if (format_->encode_command(command_, {.robot_id = robot_id_}, packet_)) return packet_;
      if (format_->encode_command(as_body_velocity(command_), {.robot_id = robot_id_}, packet_))
        return packet_;
      if (scenario_.path == CommandPath::kRadio) {
        throw std::invalid_argument(
            fmt::format("{}: commands = \"radio\": {} cannot say the command at {:g} s", scenario_.file,
                        format_->id, static_cast<double>(session_.now_ns()) * 1e-9));
      }
    }
    past_radio_ = true;
    session_.command(0, command_);
    return packet_;
  }

  const Scenario& scenario_;
  ScenarioConsole* console_;  // null: nobody listens
  WheelGeometry<double> geometry_;
  RobotModel model_;
  int robot_id_;
  Session session_;
  const RadioFormat* format_ = nullptr;  // null: commands go past the radio
  bool past_radio_ = false, silent_ = false;
  RobotCommand command_{};
  std::int64_t next_packet_ns_ = 0;
  ScenarioSample sample_;
  std::uint64_t stale_periods_ = 0;
  std::vector<std::uint8_t> packet_, answer_;
  ScenarioRun run_;
  std::vector<std::uint8_t> marked_;          // the world at the last mark
  std::unique_ptr<VariableWatch> variables_;  // null: nothing of the firmware is looked at
};

}  // namespace

ScenarioRun run_scenario(const Scenario& scenario, const SessionConfig& config,
                         const Session::FirmwareMaker& make_firmware, const ScenarioVariables& variables,
                         ScenarioConsole* console) {
  return Bench(scenario, config, make_firmware, variables, console).run();
}

}  // namespace omnihil
