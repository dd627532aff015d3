#include "hil/loop/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "hil/loop/mover_values.h"
#include "hil/loop/session_checks.h"
#include "hil/loop/thread_pool.h"
#include "protocols/radio_format.h"

namespace omnihil {
namespace {
constexpr double kRowSpacing_m = 0.5;
constexpr double kOpponentRow_m = 2.0;
constexpr std::size_t kMaxFrameBytes = 512;  // of a frame that a firmware writes; radio packets are shorter
constexpr int kMaxFramesPerTick = 16;  // so that a firmware that never stops sending cannot stop the loop

// A firmware that sets the legs of its robot's bridges, as the plant calls it.
// After Session::set_world() its clock and its counts go on where they were.
struct MotorPort : MotorControl {
  explicit MotorPort(Firmware& of) : firmware(of) {}
  MotorDrive motor_tick(const MotorSensors& sensors) override {
    return firmware.motor_tick(shifted ? shifted_sensors(sensors) : sensors);
  }
  bool runs_in_periods() const override { return firmware.runs_in_phase_periods(); }
  PhaseLegs phase_period(const PhasePeriod& period) override {
    if (!shifted) return firmware.phase_period(period);
    PhasePeriod seen = period;
    seen.begin = shifted_sensors(period.begin);
    seen.end_ns += clock_offset_ns;
    return firmware.phase_period(seen);
  }
  bool runs_aside() const override { return firmware.tick_parts() > 0; }
  MotorSensors shifted_sensors(MotorSensors seen) const {
    seen.now_ns = static_cast<std::uint64_t>(static_cast<std::int64_t>(seen.now_ns) + clock_offset_ns);
    for (std::size_t w = 0; w < kWheels; ++w) seen.encoder_counts[w] += count_offsets[w];
    return seen;
  }
  Firmware& firmware;
  bool shifted = false;
  std::int64_t clock_offset_ns = 0;
  std::array<std::int64_t, kWheels> count_offsets{};
};
std::vector<RobotModel> all_robots(const SessionConfig& config) {
  std::vector<RobotModel> robots = config.robots;
  robots.insert(robots.end(), config.opponents.robots.begin(), config.opponents.robots.end());
  return robots;
}

WorldOptions world_options(const FieldSetup& field) {
  WorldOptions options;
  options.contacts = options.handling = field.contacts;
  options.field = field.size;
  options.carpet = field.carpet;
  options.ball.lift_coefficient = field.ball_lift_coefficient;
  return options;
}
}  // namespace

struct Session::Impl {
  // A team's dongle, and its robots among all.
  struct TeamPort : RadioSink {
    TeamPort(Impl& session, std::size_t first_robot, const std::vector<int>& ids)
        : impl(session), first(first_robot), robot_ids(ids) {}
    std::optional<std::size_t> index_of(int id) const {
      const auto at = std::lower_bound(robot_ids.begin(), robot_ids.end(), id);
      if (at == robot_ids.end() || *at != id) return std::nullopt;
      return first + static_cast<std::size_t>(at - robot_ids.begin());
    }
    void deliver(const Delivery& delivery, std::int64_t at_ns) override {
      impl.deliver(*this, delivery, at_ns);
    }
    Impl& impl;
    std::size_t first;
    const std::vector<int>& robot_ids;
    std::unique_ptr<Air> air;  // before the link, which asks it
    std::unique_ptr<RadioLink> link;
  };

  Impl(SessionConfig configuration, const FirmwareMaker& make_firmware,
       const FirmwareMaker& opponents_firmware)
      : config(std::move(configuration)),
        models(all_robots(config)),
        world(make_world(config, models)),
        own(*this, 0, config.robot_ids),
        opponents(*this, config.robots.size(), config.opponents.robot_ids) {
    const std::size_t ours = config.robots.size();
    for (std::size_t i = 0; i < models.size(); ++i) {
      const bool other = i >= ours;
      const int id = other ? config.opponents.robot_ids[i - ours] : config.robot_ids[i];
      keys.push_back(other ? kOpponentKey + id : id);
      const FirmwareMaker& maker = other && opponents_firmware ? opponents_firmware : make_firmware;
      firmware.push_back(maker(robot_config(models[i], id)));
      const double y_m = kRowSpacing_m * static_cast<double>(other ? i - ours : i);
      world.put_robot(static_cast<int>(i), other ? kOpponentRow_m : 0.0, y_m, other ? std::numbers::pi : 0.0);
    }
    throw_problems(firmware_problems(config, firmware));
    motor_ports.reserve(firmware.size());  // the plant keeps their addresses
    for (std::size_t i = 0; i < firmware.size(); ++i) {
      motor_ports.emplace_back(*firmware[i]);
      if (firmware[i]->drives_phases()) world.plant().set_motor_control(static_cast<int>(i), &motor_ports[i]);
    }
    open_link(own, config.radio_format, config.team);
    if (!config.opponents.radio_format.empty())
      open_link(opponents, config.opponents.radio_format,
                config.team == Team::kBlue ? Team::kYellow : Team::kBlue);
    if (config.field.ball_m) {
      const auto [x_m, y_m] = *config.field.ball_m;
      world.put_ball(x_m, y_m, 0.0, {0, 0, 0});
    }
    shaft_offsets.resize(firmware.size());
    shafts_before.resize(firmware.size());
    if (!config.from.empty() && !set_world(config.from))
      throw_problems({"the snapshot is of other robots, another physics or another program"});
    next_tick_ns.assign(firmware.size(), 0);
    begun.assign(firmware.size(), 0);
    if (config.threads > 1) pool = std::make_unique<ThreadPool>(config.threads);
    world.plant().set_workers(pool.get());
    samples.resize(firmware.size());
    answer.reserve(4096);
  }

  bool set_world(std::span<const std::uint8_t> saved) {
    std::vector<MotorSensors> before;
    for (std::size_t i = 0; i < models.size(); ++i)
      before.push_back(world.plant().motor_sensors(static_cast<int>(i)));
    if (!world.restore(saved)) return false;
    const std::int64_t offset_ns = now_ns - world.now_ns();
    world.set_clock_offset(offset_ns);
    for (ShaftOffsets& offsets : shaft_offsets) offsets.due = now_ns > 0;
    for (std::size_t i = 0; i < motor_ports.size(); ++i) {
      MotorPort& port = motor_ports[i];
      const MotorSensors after = world.plant().motor_sensors(static_cast<int>(i));
      port.shifted = true;
      port.clock_offset_ns = offset_ns;
      for (std::size_t w = 0; w < kWheels && now_ns > 0; ++w)
        port.count_offsets[w] += before[i].encoder_counts[w] - after.encoder_counts[w];
    }
    return true;
  }

  // What turns must not jump under a firmware that goes on: counts and shafts after set_world() continue those before.
  struct ShaftOffsets {
    bool due = false;
    std::array<std::int64_t, kWheels> counts{};
    std::array<double, kWheels> theta_rotor_rad{};
  };
  void continue_shafts(std::size_t i, const std::array<std::int64_t, kWheels>& counts_before,
                       RobotSample& sample, RobotShafts& shafts) {
    ShaftOffsets& offsets = shaft_offsets[i];
    for (std::size_t w = 0; w < kWheels; ++w) {
      if (offsets.due) {
        offsets.counts[w] = counts_before[w] - sample.sensors.encoder_counts[w];
        offsets.theta_rotor_rad[w] = shafts_before[i].theta_rotor_rad[w] - shafts.theta_rotor_rad[w];
      }
      sample.sensors.encoder_counts[w] += offsets.counts[w];
      shafts.theta_rotor_rad[w] += offsets.theta_rotor_rad[w];
    }
    offsets.due = false;
    shafts_before[i] = shafts;
  }

  void open_link(TeamPort& port, const std::string& format, Team team) {
    RadioLinkConfig link_config;
    link_config.robot_ids = port.robot_ids;
    link_config.team = team;
    link_config.firmware_decodes = firmware[port.first]->radio_format() == format;
    link_config.epoch_ms = config.epoch_ms;
    link_config.wheel_radius_m = models[port.first].wheel_radius_m;
    const bool silence = any_silence(config.faults);
    if (config.air.any() || silence) {
      // Each team draws from a seed of its own.
      const bool other = &port == &opponents;
      std::function<bool(int)> silent;
      if (silence)
        silent = [this, other](int id) {
          return silent_at(config.faults, other ? kOpponentKey + id : id, now_ns);
        };
      port.air = std::make_unique<Air>(
          config.air, config.plant.seed + (other ? 1 : 0),
          [this, &port](int id) { return position_of(port, id); }, std::move(silent));
      link_config.air = port.air.get();
    }
    port.link = find_radio_format(format)->make_link(link_config);
  }

  std::pair<double, double> position_of(const TeamPort& port, int id) const {
    const auto index = port.index_of(id);
    if (!index) return {0.0, 0.0};
    const PlanarState state = world.plant().planar_state(static_cast<int>(*index));
    return {state.x_m, state.y_m};
  }

  static World make_world(const SessionConfig& config, const std::vector<RobotModel>& models) {
    throw_problems(session_problems(config));
    return World(models, config.plant, world_options(config.field));
  }

  void deliver(const TeamPort& port, const Delivery& delivery, std::int64_t at_ns) {
    const auto index = port.index_of(delivery.robot_id);
    if (observer && &port == &own) observer->delivery(at_ns, delivery);
    if (!index) return;
    Firmware& robot = *firmware[*index];
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

  // What robot i's sensors show at the plant's time.
  void sense(std::size_t i) {
    RobotSample& sample = samples[i];
    sample.robot_id = keys[i];
    const auto counts_before = std::to_array(sample.sensors.encoder_counts);
    sample.sensors = world.sample_sensors(static_cast<int>(i));
    sample.sensors.now_us = static_cast<std::uint64_t>(now_ns / 1000);  // the plant's, but after set_world()
    sample.truth = world.plant().truth(static_cast<int>(i));
    RobotShafts shafts{};
    std::copy_n(sample.truth.theta_rotor_rad.begin(), kWheels, shafts.theta_rotor_rad);
    std::copy_n(sample.truth.omega_rotor_rad_s.begin(), kWheels, shafts.omega_rotor_rad_s);
    continue_shafts(i, counts_before, sample, shafts);
    firmware[i]->shafts(shafts);
  }

  // The parts of all ticks that are due now and have any.
  void run_parts() {
    parts.clear();
    for (std::size_t i = 0; i < firmware.size(); ++i) {
      const std::size_t count = next_tick_ns[i] == now_ns ? firmware[i]->tick_parts() : 0;
      begun[i] = count > 0;
      if (count == 0) continue;
      sense(i);
      firmware[i]->begin_tick(samples[i].sensors);
      // Those that drive phases have nothing to do there: they run on in their motor ticks.
      for (std::size_t part = 0; part < count; ++part) {
        if (firmware[i]->drives_phases())
          firmware[i]->run_part(part);
        else
          parts.emplace_back(i, part);
      }
    }
    pool->each(parts.size(), [this](std::size_t n) { firmware[parts[n].first]->run_part(parts[n].second); });
  }

  // One control tick of robot i at the plant's time, or the rest of it.
  void tick(std::size_t i) {
    TeamPort& port = i < opponents.first ? own : opponents;
    const int id = port.robot_ids[i - port.first];
    Firmware& robot = *firmware[i];
    RobotSample& sample = samples[i];
    if (begun[i] != 0) {
      sample.drive = robot.end_tick();
    } else {
      sense(i);
      sample.drive = robot.tick(sample.sensors);
    }
    begun[i] = 0;
    robot.tell();
    sample.feedback = robot.feedback();
    sample.vision = world.plant().vision(static_cast<int>(i));
    if (watch) sample.watched = watch->read(static_cast<int>(i), robot);
    if (const std::string broken = first_non_finite(sample); !broken.empty())
      give_up(now_ns, keys[i], broken);
    world.write(static_cast<int>(i), sample.drive);
    for (int frames = 0; frames < kMaxFramesPerTick; ++frames) {
      const std::size_t n = robot.radio_transmit(frame);
      if (n == 0) break;
      if (port.link) port.link->robot_frame(id, std::span(frame).first(std::min(n, frame.size())), now_ns);
    }
    if (port.link) port.link->robot_feedback(id, sample.feedback, robot.gains(), now_ns);
    if (observer) observer->robot_tick(now_ns, sample);
  }

  [[noreturn]] static void give_up(std::int64_t at_ns, int id, const std::string& signal) {
    throw std::runtime_error(fmt::format("at {:.6f} s robot {}: {} is not finite; the run ends here",
                                         static_cast<double>(at_ns) * 1e-9, id, signal));
  }

  // Robots that the plan names; faults of others are their callers'.
  void take_faults() {
    for (std::size_t i = 0; i < keys.size(); ++i) {
      const bool named =
          std::ranges::any_of(config.faults, [&](const TimedFault& f) { return f.key == keys[i]; });
      if (!named) continue;
      const RobotFaults now = faults_at(config.faults, keys[i], now_ns);
      const int index = static_cast<int>(i);
      if (now != world.plant().faults(index)) world.plant().set_faults(index, now);
    }
  }

  void run_until(std::int64_t end_ns) {
    while (now_ns < end_ns) {
      std::int64_t until_ns = end_ns;
      if (pool) run_parts();
      for (std::size_t i = 0; i < firmware.size(); ++i) {
        if (next_tick_ns[i] == now_ns) {
          tick(i);
          next_tick_ns[i] += firmware[i]->control_period_ns();
        }
        until_ns = std::min(until_ns, next_tick_ns[i]);
      }
      const std::int64_t world_ns = world.now_ns();
      world.advance(until_ns - now_ns);
      for (const auto& robot : firmware) robot->tell();
      if (observer && config.field.contacts) observer->world(until_ns, world);
      if (const auto& fault = world.plant().fault()) {
        give_up(fault->now_ns + now_ns - world_ns, keys[static_cast<std::size_t>(fault->robot)],
                fmt::format("{}[{}]", fault->signal, fault->index));
      }
      now_ns = until_ns;
    }
  }

  SessionConfig config;
  std::vector<RobotModel> models;  // of both teams
  World world;
  std::vector<int> keys;
  std::vector<std::unique_ptr<Firmware>> firmware;
  std::vector<MotorPort> motor_ports;
  TeamPort own, opponents;
  SessionObserver* observer = nullptr;
  FirmwareWatch* watch = nullptr;
  std::int64_t now_ns = 0;
  std::vector<std::int64_t> next_tick_ns;
  std::unique_ptr<ThreadPool> pool;                        // null: one thread
  std::vector<std::pair<std::size_t, std::size_t>> parts;  // robot, part of its tick
  std::vector<std::uint8_t> begun;  // by robot: its parts have run, the tick is not over
  std::vector<RobotSample> samples;
  std::vector<ShaftOffsets> shaft_offsets;
  std::vector<RobotShafts> shafts_before;
  std::vector<std::uint8_t> answer;
  std::array<std::uint8_t, kMaxFrameBytes> frame{};
  std::uint64_t gains_refused = 0;
};

Session::Session(SessionConfig config, const FirmwareMaker& make_firmware,
                 const FirmwareMaker& opponents_firmware)
    : impl_(std::make_unique<Impl>(std::move(config), make_firmware, opponents_firmware)) {}
Session::~Session() = default;

std::int64_t Session::now_ns() const { return impl_->now_ns; }
const SessionConfig& Session::config() const { return impl_->config; }
const Plant& Session::plant() const { return impl_->world.plant(); }
const World& Session::world() const { return impl_->world; }
SessionConfig opponents_alone(const SessionConfig& config) {
  SessionConfig alone = config;
  alone.robots = config.opponents.robots;
  alone.robot_ids = config.opponents.robot_ids;
  if (!config.opponents.radio_format.empty()) alone.radio_format = config.opponents.radio_format;
  alone.opponents = {};
  alone.faults.clear();
  return alone;
}

int Session::robot_count() const { return static_cast<int>(impl_->models.size()); }
int Session::robot_key(int robot_index) const { return impl_->keys[static_cast<std::size_t>(robot_index)]; }
const RobotModel& Session::model(int robot_index) const {
  return impl_->models[static_cast<std::size_t>(robot_index)];
}
const RadioLink& Session::link() const { return *impl_->own.link; }
const RadioLink* Session::opponents_link() const { return impl_->opponents.link.get(); }
void Session::set_watch(FirmwareWatch* watch) { impl_->watch = watch; }
FirmwareMemory* Session::firmware_memory(int robot_index) {
  return impl_->firmware[static_cast<std::size_t>(robot_index)]->memory();
}
FirmwareChip* Session::firmware_chip(int robot_index) {
  return impl_->firmware[static_cast<std::size_t>(robot_index)]->chip();
}
const Firmware& Session::firmware(int robot_index) const {
  return *impl_->firmware[static_cast<std::size_t>(robot_index)];
}
AirCounts Session::air() const { return impl_->own.air ? impl_->own.air->counts() : AirCounts{}; }
void Session::set_observer(SessionObserver* observer) { impl_->observer = observer; }
std::uint64_t Session::gains_refused() const { return impl_->gains_refused; }

void Session::step(std::span<const std::uint8_t> host, std::vector<std::uint8_t>& out) {
  std::vector<std::uint8_t> nothing;
  step(host, out, {}, nothing);
}

void Session::step(std::span<const std::uint8_t> host, std::vector<std::uint8_t>& out,
                   std::span<const std::uint8_t> opponents_host, std::vector<std::uint8_t>& opponents_out) {
  Impl& s = *impl_;
  if (!s.config.faults.empty()) s.take_faults();
  RadioLink* const other = s.opponents.link.get();
  if (!host.empty()) {
    if (s.observer) s.observer->host_bytes(s.now_ns, host);
    s.own.link->host_bytes(host, s.now_ns);
  }
  if (other != nullptr && !opponents_host.empty()) {
    if (s.observer) s.observer->opponents_bytes(s.now_ns, opponents_host);
    other->host_bytes(opponents_host, s.now_ns);
  }
  s.own.link->poll(s.now_ns, s.own);
  if (other != nullptr) other->poll(s.now_ns, s.opponents);
  s.run_until(s.now_ns + s.config.step_ns);
  s.answer.clear();
  s.own.link->take_host_bytes(s.now_ns, s.answer);
  if (!s.answer.empty() && s.observer) s.observer->dongle_bytes(s.now_ns, s.answer);
  out.insert(out.end(), s.answer.begin(), s.answer.end());
  if (other != nullptr) other->take_host_bytes(s.now_ns, opponents_out);
}

void Session::command(int robot_index, const RobotCommand& command) {
  if (impl_->observer) impl_->observer->command(impl_->now_ns, robot_key(robot_index), command);
  impl_->firmware[static_cast<std::size_t>(robot_index)]->command(command, impl_->now_ns);
}

void Session::set_faults(int robot_index, const RobotFaults& faults) {
  impl_->world.plant().set_faults(robot_index, faults);
}

void Session::set_pose(int robot_index, double x_m, double y_m, double yaw_rad) {
  Impl& s = *impl_;
  if (s.observer) s.observer->placed(s.now_ns, robot_key(robot_index), x_m, y_m, yaw_rad);
  s.world.put_robot(robot_index, x_m, y_m, yaw_rad);
}

void Session::set_velocity(int robot_index, double v_x_m_s, double v_y_m_s, double omega_rad_s) {
  Impl& s = *impl_;
  const double speeds[] = {v_x_m_s, v_y_m_s, omega_rad_s};
  if (s.observer) s.observer->field_input(s.now_ns, FieldInput::kPushed, robot_key(robot_index), speeds);
  s.world.set_velocity(robot_index, v_x_m_s, v_y_m_s, omega_rad_s);
}

void Session::set_present(int robot_index, bool present) {
  Impl& s = *impl_;
  if (s.world.present(robot_index) == present) return;
  const double value[] = {present ? 1.0 : 0.0};
  if (s.observer) s.observer->field_input(s.now_ns, FieldInput::kPresent, robot_key(robot_index), value);
  s.world.set_present(robot_index, present);
}

void Session::put_ball(const Vector3& position, const Vector3& velocity, const Vector3& spin) {
  Impl& s = *impl_;
  const double values[] = {position.x(), position.y(), position.z(), velocity.x(), velocity.y(),
                           velocity.z(), spin.x(),     spin.y(),     spin.z()};
  if (s.observer) s.observer->field_input(s.now_ns, FieldInput::kBall, 0, values);
  s.world.put_ball(position.x(), position.y(), position.z(), velocity, spin);
}

void Session::take_ball_away() {
  if (impl_->observer) impl_->observer->field_input(impl_->now_ns, FieldInput::kBall, 0, {});
  impl_->world.take_ball_away();
}

void Session::set_movers(std::span<const Mover> movers) {
  if (impl_->observer)
    impl_->observer->field_input(impl_->now_ns, FieldInput::kMovers, 0, mover_values(movers));
  impl_->world.set_movers(movers);
}

bool Session::set_world(std::span<const std::uint8_t> saved) { return impl_->set_world(saved); }

void Session::host_closed() {
  if (impl_->observer) impl_->observer->host_closed(impl_->now_ns);
  impl_->own.link->host_closed(impl_->now_ns);
}

}  // namespace omnihil
