#include "sim/field/world.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sim/field/world_impl.h"
#include "sim/robot/plain_bytes.h"

namespace omnihil {

World::Impl::Impl(std::span<const RobotModel> robots, const PlantOptions& plant_options,
                  const WorldOptions& world_options)
    : options(world_options),
      models(robots.begin(), robots.end()),
      plant(robots, plant_options),
      handling(robots.size()),
      here(robots.size(), 1),
      tipped(robots.size()),
      drives(robots.size()),
      states(robots.size()),
      shapes(robots.size()),
      shape_known(robots.size()),
      body(robots.size()),
      roller(robots.size()) {
  for (const RobotModel& model : models) {
    const PlanarBody<double> b = planar_body(model);
    parts.push_back({b.mass_kg, 1.0 / b.inverse_yaw_inertia, {b.com_x_m, b.com_y_m}, &handling_of(model)});
    tip_rad.push_back(tipping_angle_rad(model));
  }
  if (options.field == nullptr) return;
  boards = goal_boards(*options.field);
  for (std::size_t i = 0; i < boards.size(); ++i)
    board_shapes[i] = box_shape(boards[i].x_from_m, boards[i].x_to_m, boards[i].y_from_m, boards[i].y_to_m);
}

void World::Impl::report(WorldEventKind kind, int robot, int other, double x_m, double y_m, double size) {
  events.push_back({kind, plant.now_ns() + clock_offset_ns, robot, other, x_m, y_m, size});
}

void World::Impl::after_step(Plant&, double step_s) {
  ++steps;
  const std::size_t count = parts.size();
  if (!options.contacts && !options.handling && !has_ball) return;
  for (Mover& mover : movers) {
    mover.state.x_m += step_s * mover.state.v_x_m_s;
    mover.state.y_m += step_s * mover.state.v_y_m_s;
    mover.state.yaw_rad += step_s * mover.state.omega_rad_s;
  }
  const bool may_touch = has_ball || count > 1 || options.field != nullptr || !movers.empty();
  if (may_touch)
    for (std::size_t n = 0; n < count; ++n) states[n] = plant.planar_state(static_cast<int>(n));
  if (options.handling)
    for (std::size_t n = 0; n < count; ++n) handle_ball(n, step_s);
  if (has_ball) advance_ball(options.ball, options.carpet, ball, step_s);
  if (may_touch) touch_all(step_s);
  if (!has_ball || options.field == nullptr) return;
  const int side =
      goal_at(*options.field, options.ball.radius_m, ball.position.x(), ball.position.y(), ball.position.z());
  if (side != 0 && goal_side == 0)
    report(WorldEventKind::kGoal, side, -1, ball.position.x(), ball.position.y(), ball.velocity.norm());
  goal_side = side;
}

World::World(std::span<const RobotModel> robots, const PlantOptions& plant, const WorldOptions& options)
    : impl_(std::make_unique<Impl>(robots, plant, options)) {}
World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

Plant& World::plant() { return impl_->plant; }
const Plant& World::plant() const { return impl_->plant; }
const WorldOptions& World::options() const { return impl_->options; }
std::int64_t World::now_ns() const { return impl_->plant.now_ns(); }
const BallState* World::ball() const { return impl_->has_ball ? &impl_->ball : nullptr; }
const HandlingState& World::handling(int robot) const {
  return impl_->handling[static_cast<std::size_t>(robot)];
}
std::span<const WorldEvent> World::events() const { return impl_->events; }
bool World::present(int robot) const { return impl_->here[static_cast<std::size_t>(robot)] != 0; }
void World::set_present(int robot, bool present) { impl_->here[static_cast<std::size_t>(robot)] = present; }

void World::put_ball(double x_m, double y_m, double z_m, const Vector3& velocity, const Vector3& spin) {
  Impl& w = *impl_;
  const double r_m = w.options.ball.radius_m;
  w.has_ball = true;
  w.ball = resting_ball(w.options.ball, x_m, y_m);
  w.ball.position.z() = std::max(z_m, r_m);
  w.ball.velocity = velocity;
  w.ball.spin = spin;
  w.ball.on_floor = w.ball.position.z() <= r_m && velocity.z() <= 0.0;
  if (w.ball.on_floor) w.ball.velocity.z() = 0.0;
}
void World::take_ball_away() { impl_->has_ball = false; }

void World::put_robot(int robot, double x_m, double y_m, double yaw_rad) {
  impl_->plant.set_pose(robot, x_m, y_m, yaw_rad);
}
void World::set_velocity(int robot, double v_x_m_s, double v_y_m_s, double omega_rad_s) {
  const PlanarState s = impl_->plant.planar_state(robot);
  impl_->plant.add_velocity(robot, v_x_m_s - s.v_x_m_s, v_y_m_s - s.v_y_m_s, omega_rad_s - s.omega_rad_s);
}

void World::write(int robot, const RobotDrive& drive) {
  const auto n = static_cast<std::size_t>(robot);
  impl_->drives[n] = drive;
  impl_->plant.write(robot, drive);
  if (impl_->options.handling) impl_->begin_kick(n, drive);
}

void World::advance(std::int64_t duration_ns) {
  impl_->events.clear();
  impl_->plant.advance(duration_ns, impl_.get());
  impl_->look_for_tips();
}

void World::set_clock_offset(std::int64_t offset_ns) { impl_->clock_offset_ns = offset_ns; }

RobotSensors World::sample_sensors(int robot) {
  RobotSensors s = impl_->plant.sample_sensors(robot);
  const HandlingState& h = handling(robot);
  s.ball_seen = h.ball_seen ? 1u : 0u;
  s.capacitor_V = h.capacitor_V;
  return s;
}

double World::energy_J() const {
  const Impl& w = *impl_;
  double sum_J = w.has_ball ? ball_energy_J(w.options.ball, w.ball) : 0.0;
  for (std::size_t n = 0; n < w.parts.size(); ++n) {
    const PlanarState s = w.plant.planar_state(static_cast<int>(n));
    const double c = std::cos(s.yaw_rad), sn = std::sin(s.yaw_rad);
    const Vector2& com = w.parts[n].com;
    const double vx = s.v_x_m_s - s.omega_rad_s * (sn * com.x() + c * com.y());
    const double vy = s.v_y_m_s + s.omega_rad_s * (c * com.x() - sn * com.y());
    sum_J += 0.5 * w.parts[n].mass_kg * (vx * vx + vy * vy) +
             0.5 * w.parts[n].inertia_kg_m2 * s.omega_rad_s * s.omega_rad_s;
  }
  return sum_J;
}

namespace {
// All that a world remembers beside its plant; visit(first, count) in the order in which it is kept.
template <typename Impl, typename Visit>
void each_memory(Impl& w, Visit visit) {
  visit(&w.has_ball, 1);
  visit(w.ball.position.data(), 3);
  visit(w.ball.velocity.data(), 3);
  visit(w.ball.spin.data(), 3);
  visit(&w.ball.on_floor, 1);
  visit(w.handling.data(), w.handling.size());
  visit(w.here.data(), w.here.size());
  visit(w.tipped.data(), w.tipped.size());
  visit(w.drives.data(), w.drives.size());
  visit(&w.steps, 1);
  visit(&w.goal_side, 1);
}
}  // namespace

std::vector<std::uint8_t> World::save() const {
  const Impl& w = *impl_;
  const std::vector<std::uint8_t> plant = w.plant.save();
  const std::uint64_t size = plant.size();
  std::vector<std::uint8_t> out;
  append(out, &size, 1);
  append(out, plant.data(), plant.size());
  each_memory(w, [&](const auto* first, std::size_t count) { append(out, first, count); });
  return out;
}

bool World::restore(std::span<const std::uint8_t> bytes) {
  Impl& w = *impl_;
  if (bytes.size() != save().size()) return false;
  std::uint64_t size = 0;
  take(bytes, &size, 1);
  if (size > bytes.size() || !w.plant.restore(bytes.first(size))) return false;
  bytes = bytes.subspan(size);
  each_memory(w, [&](auto* first, std::size_t count) { take(bytes, first, count); });
  w.touched_before.clear();
  return true;
}

}  // namespace omnihil
