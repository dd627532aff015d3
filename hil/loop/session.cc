#include "hil/loop/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "hil/loop/session_checks.h"
#include "protocols/radio_format.h"

namespace omnihil {
namespace {
constexpr double kRowSpacing_m = 0.5;
constexpr std::size_t kMaxFrameBytes = 512;  // of a frame that a firmware writes; radio packets are shorter
constexpr int kMaxFramesPerTick = 16;  // so that a firmware that never stops sending cannot stop the loop

// A firmware that sets the legs of its robot's bridges, as the plant calls it.
struct MotorPort : MotorControl {
  explicit MotorPort(Firmware& of) : firmware(of) {}
  MotorDrive motor_tick(const MotorSensors& sensors) override { return firmware.motor_tick(sensors); }
  Firmware& firmware;
};
}  // namespace

struct Session::Impl : RadioSink {
  Impl(SessionConfig configuration, const FirmwareMaker& make_firmware)
      : config(std::move(configuration)), plant(make_plant(config)) {
    for (std::size_t i = 0; i < config.robots.size(); ++i) {
      firmware.push_back(make_firmware(robot_config(config.robots[i], config.robot_ids[i])));
      plant.set_pose(static_cast<int>(i), 0.0, kRowSpacing_m * static_cast<double>(i), 0.0);
    }
    throw_problems(firmware_problems(config, firmware));
    motor_ports.reserve(firmware.size());  // the plant keeps their addresses
    for (std::size_t i = 0; i < firmware.size(); ++i) {
      motor_ports.emplace_back(*firmware[i]);
      if (firmware[i]->drives_phases()) plant.set_motor_control(static_cast<int>(i), &motor_ports[i]);
    }
    RadioLinkConfig link_config;
    link_config.robot_ids = config.robot_ids;
    link_config.team = config.team;
    link_config.firmware_decodes = firmware[0]->radio_format() == config.radio_format;
    link_config.epoch_ms = config.epoch_ms;
    link_config.wheel_radius_m = config.robots[0].wheel_radius_m;
    if (config.air.any()) {
      air = std::make_unique<AirLoss>(config.air, config.plant.seed,
                                      [this](int id) { return position_of(id); });
      link_config.air = air.get();
    }
    link = find_radio_format(config.radio_format)->make_link(link_config);
    next_tick_ns.assign(firmware.size(), 0);
    samples.resize(firmware.size());
    answer.reserve(4096);
  }

  std::pair<double, double> position_of(int id) const {
    const auto at = std::lower_bound(config.robot_ids.begin(), config.robot_ids.end(), id);
    if (at == config.robot_ids.end()) return {0.0, 0.0};
    const RobotTruth truth = plant.truth(static_cast<int>(at - config.robot_ids.begin()));
    return {truth.x_m, truth.y_m};
  }

  static Plant make_plant(const SessionConfig& config) {
    throw_problems(session_problems(config));
    return Plant(config.robots, config.plant);
  }

  void deliver(const Delivery& delivery, std::int64_t at_ns) override {
    if (observer) observer->delivery(at_ns, delivery);
    const auto id = std::lower_bound(config.robot_ids.begin(), config.robot_ids.end(), delivery.robot_id);
    if (id == config.robot_ids.end() || *id != delivery.robot_id) return;
    Firmware& robot = *firmware[static_cast<std::size_t>(id - config.robot_ids.begin())];
    switch (delivery.kind) {
      case Delivery::Kind::kCommand:
        robot.command(delivery.command, at_ns);
        break;
      case Delivery::Kind::kFrame:
        robot.radio_receive(delivery.frame, at_ns);
        break;
      case Delivery::Kind::kGains:
        if (!robot.set_gains(delivery.gains)) ++gains_refused;
        break;
    }
  }

  // One control tick of robot i at the plant's time.
  void tick(std::size_t i) {
    const int id = config.robot_ids[i];
    Firmware& robot = *firmware[i];
    RobotSample& sample = samples[i];
    sample.robot_id = id;
    sample.sensors = plant.sample_sensors(static_cast<int>(i));
    sample.truth = plant.truth(static_cast<int>(i));
    RobotShafts shafts;
    std::copy_n(sample.truth.theta_rotor_rad.begin(), kWheels, shafts.theta_rotor_rad);
    std::copy_n(sample.truth.omega_rotor_rad_s.begin(), kWheels, shafts.omega_rotor_rad_s);
    robot.shafts(shafts);
    sample.drive = robot.tick(sample.sensors);
    sample.feedback = robot.feedback();
    sample.vision = plant.vision(static_cast<int>(i));
    if (const std::string broken = first_non_finite(sample); !broken.empty()) give_up(now_ns, id, broken);
    plant.write(static_cast<int>(i), sample.drive);
    for (int frames = 0; frames < kMaxFramesPerTick; ++frames) {
      const std::size_t n = robot.radio_transmit(frame);
      if (n == 0) break;
      link->robot_frame(id, std::span(frame).first(std::min(n, frame.size())), now_ns);
    }
    link->robot_feedback(id, sample.feedback, robot.gains(), now_ns);
    if (observer) observer->robot_tick(now_ns, sample);
  }

  [[noreturn]] static void give_up(std::int64_t at_ns, int id, const std::string& signal) {
    throw std::runtime_error(fmt::format("at {:.6f} s robot {}: {} is not finite; the run ends here",
                                         static_cast<double>(at_ns) * 1e-9, id, signal));
  }

  void run_until(std::int64_t end_ns) {
    while (now_ns < end_ns) {
      std::int64_t until_ns = end_ns;
      for (std::size_t i = 0; i < firmware.size(); ++i) {
        if (next_tick_ns[i] == now_ns) {
          tick(i);
          next_tick_ns[i] += firmware[i]->control_period_ns();
        }
        until_ns = std::min(until_ns, next_tick_ns[i]);
      }
      plant.advance(until_ns - now_ns);
      if (const auto& fault = plant.fault()) {
        give_up(fault->now_ns, config.robot_ids[static_cast<std::size_t>(fault->robot)],
                fmt::format("{}[{}]", fault->signal, fault->index));
      }
      now_ns = until_ns;
    }
  }

  SessionConfig config;
  Plant plant;
  std::vector<std::unique_ptr<Firmware>> firmware;
  std::vector<MotorPort> motor_ports;
  std::unique_ptr<AirLoss> air;  // before the link, which asks it
  std::unique_ptr<RadioLink> link;
  SessionObserver* observer = nullptr;
  std::int64_t now_ns = 0;
  std::vector<std::int64_t> next_tick_ns;
  std::vector<RobotSample> samples;
  std::vector<std::uint8_t> answer;
  std::array<std::uint8_t, kMaxFrameBytes> frame{};
  std::uint64_t gains_refused = 0;
};

Session::Session(SessionConfig config, const FirmwareMaker& make_firmware)
    : impl_(std::make_unique<Impl>(std::move(config), make_firmware)) {}
Session::~Session() = default;

std::int64_t Session::now_ns() const { return impl_->now_ns; }
const SessionConfig& Session::config() const { return impl_->config; }
const Plant& Session::plant() const { return impl_->plant; }
const RadioLink& Session::link() const { return *impl_->link; }
const Firmware& Session::firmware(int robot_index) const {
  return *impl_->firmware[static_cast<std::size_t>(robot_index)];
}
AirCounts Session::air() const { return impl_->air ? impl_->air->counts() : AirCounts{}; }
void Session::set_observer(SessionObserver* observer) { impl_->observer = observer; }
std::uint64_t Session::gains_refused() const { return impl_->gains_refused; }

void Session::step(std::span<const std::uint8_t> host, std::vector<std::uint8_t>& out) {
  Impl& s = *impl_;
  if (!host.empty()) {
    if (s.observer) s.observer->host_bytes(s.now_ns, host);
    s.link->host_bytes(host, s.now_ns);
  }
  s.link->poll(s.now_ns, s);
  s.run_until(s.now_ns + s.config.step_ns);
  s.answer.clear();
  s.link->take_host_bytes(s.now_ns, s.answer);
  if (s.answer.empty()) return;
  if (s.observer) s.observer->dongle_bytes(s.now_ns, s.answer);
  out.insert(out.end(), s.answer.begin(), s.answer.end());
}

void Session::command(int robot_index, const RobotCommand& command) {
  if (impl_->observer)
    impl_->observer->command(impl_->now_ns, impl_->config.robot_ids[static_cast<std::size_t>(robot_index)],
                             command);
  impl_->firmware[static_cast<std::size_t>(robot_index)]->command(command, impl_->now_ns);
}

void Session::set_faults(int robot_index, const RobotFaults& faults) {
  impl_->plant.set_faults(robot_index, faults);
}

void Session::set_pose(int robot_index, double x_m, double y_m, double yaw_rad) {
  Impl& s = *impl_;
  if (s.observer)
    s.observer->placed(s.now_ns, s.config.robot_ids[static_cast<std::size_t>(robot_index)], x_m, y_m,
                       yaw_rad);
  s.plant.set_pose(robot_index, x_m, y_m, yaw_rad);
}

void Session::host_closed() {
  if (impl_->observer) impl_->observer->host_closed(impl_->now_ns);
  impl_->link->host_closed(impl_->now_ns);
}

}  // namespace omnihil
