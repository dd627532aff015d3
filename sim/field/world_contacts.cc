// Who touches whom at the end of a mechanical step, what it does to their speeds, and how overlaps are undone.
#include <algorithm>
#include <cmath>

#include "sim/field/world_impl.h"

namespace omnihil {
namespace {

constexpr double kSlop_m = 1e-4;    // overlap that is left, so that resting contacts stay contacts
constexpr double kMendRatio = 0.5;  // of the rest, per step: a few steps, and no jump
constexpr int kMendRounds = 4;
constexpr double kRobotRestitution = 0.2;  // hulls of plastic and sheet: guess, +-50 %
constexpr double kRobotFriction = 0.3;     // guess, +-30 %

Vector3 flat(const Vector2& v, double z = 0.0) { return {v.x(), v.y(), z}; }

}  // namespace

const ConvexShape& World::Impl::shape_of(std::size_t n) {
  if (!shape_known[n])
    shapes[n] = robot_shape(parts[n].handling->outline, states[n].x_m, states[n].y_m, states[n].yaw_rad);
  shape_known[n] = true;
  return shapes[n];
}

int World::Impl::body_of(std::size_t n) {
  if (body[n] >= 0) return body[n];
  const PlanarState& s = states[n];
  const double c = std::cos(s.yaw_rad), sn = std::sin(s.yaw_rad);
  const Vector2 com(c * parts[n].com.x() - sn * parts[n].com.y(),
                    sn * parts[n].com.x() + c * parts[n].com.y());
  const Vector2 velocity(s.v_x_m_s - s.omega_rad_s * com.y(), s.v_y_m_s + s.omega_rad_s * com.x());
  body[n] = solver.add(planar_contact_body(parts[n].mass_kg, parts[n].inertia_kg_m2,
                                           Vector2(s.x_m, s.y_m) + com, velocity, s.omega_rad_s));
  return body[n];
}

int World::Impl::body_of_ball() {
  if (ball_body < 0) ball_body = solver.add(ball_contact_body(options.ball, ball));
  return ball_body;
}

void World::Impl::touch_robots(std::size_t a, std::size_t b) {
  const double dx = states[b].x_m - states[a].x_m, dy = states[b].y_m - states[a].y_m;
  const double reach_m = parts[a].handling->outline.radius_m + parts[b].handling->outline.radius_m;
  if (dx * dx + dy * dy > reach_m * reach_m) return;
  const Touch touch = touch_of(shape_of(a), shape_of(b));
  if (touch.depth_m <= 0.0) return;
  const int body_a = body_of(a), body_b = body_of(b);
  put_touch(touch, body_b, body_a, static_cast<int>(b), static_cast<int>(a));
}

// `touch` has its normal from the second to the first.
void World::Impl::put_touch(const Touch& touch, int first, int second, int who_first, int who_second) {
  for (std::size_t i = 0; i < touch.point_count; ++i) {
    Contact contact;
    contact.a = first;
    contact.b = second;
    contact.point = flat(touch.points[i]);
    contact.normal = flat(touch.normal);
    contact.restitution = kRobotRestitution;
    contact.friction = kRobotFriction;
    solver.touch(contact);
  }
  overlaps.push_back({who_first, who_second, flat(touch.normal), touch.depth_m});
  if (who_second >= 0)
    touching.emplace_back(who_second, who_first);
  else
    touching.emplace_back(who_first, who_second);
}

void World::Impl::touch_walls(std::size_t n) {
  const FieldSize& field = *options.field;
  const double out_m = field.boundary_mm / 1000.0;
  const double x_m = field.half_length_m() + out_m, y_m = field.half_width_m() + out_m;
  const double reach_m = parts[n].handling->outline.radius_m;
  const bool near_boards = std::abs(states[n].x_m) > x_m - reach_m || std::abs(states[n].y_m) > y_m - reach_m;
  const bool near_goals = std::abs(states[n].x_m) > field.half_length_m() - reach_m;
  if (!near_boards && !near_goals) return;
  const auto put = [&](const Touch& touch) {
    for (std::size_t i = 0; i < touch.point_count; ++i) {
      Contact contact;
      contact.a = body_of(n);
      contact.b = ContactSolver::kFixed;
      contact.point = flat(touch.points[i]);
      contact.normal = -flat(touch.normal);
      contact.restitution = options.wall_restitution;
      contact.friction = options.wall_friction;
      solver.touch(contact);
    }
    if (touch.depth_m > 0.0)
      overlaps.push_back({static_cast<int>(n), -1, -flat(touch.normal), touch.depth_m});
  };
  const ConvexShape& shape = shape_of(n);
  put(touch_of_wall(shape, {1, 0}, x_m));
  put(touch_of_wall(shape, {-1, 0}, x_m));
  put(touch_of_wall(shape, {0, 1}, y_m));
  put(touch_of_wall(shape, {0, -1}, y_m));
  if (!near_goals) return;
  for (const ConvexShape& board : board_shapes) put(touch_of(shape, board));
}

void World::Impl::touch_bar(std::size_t n, const Vector3& at) {
  const DribblerModel& d = parts[n].handling->dribbler;
  if (std::abs(at.y()) > d.half_width_m) return;
  const double x_m = at.x() - d.bar_x_m, z_m = at.z() - d.bar_z_m;
  const double distance_m = std::hypot(x_m, z_m);
  const double depth_m = options.ball.radius_m + d.bar_radius_m - distance_m;
  if (depth_m <= 0.0 || x_m <= 0.0) return;
  const double c = std::cos(states[n].yaw_rad), s = std::sin(states[n].yaw_rad);
  if (roller[n] < 0)
    roller[n] =
        solver.add(Roller{{-s, c, 0.0}, d.bar_radius_m, 1.0 / d.inertia_kg_m2, handling[n].omega_bar_rad_s});
  Contact contact;
  contact.a = body_of_ball();
  contact.b = body_of(n);
  contact.roller = roller[n];
  contact.normal = Vector3(c * x_m, s * x_m, z_m) / distance_m;
  contact.point = ball.position - options.ball.radius_m * contact.normal;
  contact.friction = d.friction;
  contact.stiffness_N_per_m = d.mount_stiffness_N_per_m;
  contact.damping_N_s_per_m = d.mount_damping_N_s_per_m;
  contact.depth_m = depth_m;
  solver.touch(contact);
}

void World::Impl::touch_ball_with_hull(const RobotOutline& outline, const PlanarState& state,
                                       double restitution, double friction, int who) {
  const double c = std::cos(state.yaw_rad), s = std::sin(state.yaw_rad);
  const double dx = ball.position.x() - state.x_m, dy = ball.position.y() - state.y_m;
  const Vector3 at(c * dx + s * dy, -s * dx + c * dy, ball.position.z());
  // The hull is a prism: its point next to the ball's middle.
  const Nearest nearest = nearest_on(outline, {at.x(), at.y()});
  const double r_m = options.ball.radius_m, above_m = at.z() - outline.height_m;
  Vector3 normal(nearest.normal.x(), nearest.normal.y(), 0.0);
  double depth_m = r_m - nearest.distance_m;
  if (above_m > 0.0) {
    if (above_m >= r_m || nearest.distance_m >= r_m) return;
    const double out_m = std::max(0.0, nearest.distance_m), distance_m = std::hypot(out_m, above_m);
    depth_m = r_m - distance_m;
    normal = (out_m * normal + Vector3(0, 0, above_m)) / distance_m;
  }
  if (depth_m <= 0.0) return;
  Contact contact;
  contact.a = body_of_ball();
  contact.b = who >= 0 ? body_of(static_cast<std::size_t>(who))
                       : body_of_mover(static_cast<std::size_t>(kFirstMover - who));
  contact.normal = {c * normal.x() - s * normal.y(), s * normal.x() + c * normal.y(), normal.z()};
  contact.point = ball.position - r_m * contact.normal;
  contact.restitution = restitution;
  contact.friction = friction;
  solver.touch(contact);
  overlaps.push_back({kBallWho, who, contact.normal, depth_m});
  if (who >= 0) touching.emplace_back(who, kBallWho);
}
void World::Impl::touch_ball_with_robot(std::size_t n) {
  const BallHandling& h = *parts[n].handling;
  const double dx = ball.position.x() - states[n].x_m, dy = ball.position.y() - states[n].y_m;
  const double reach_m = h.outline.radius_m + 2.0 * options.ball.radius_m;
  if (dx * dx + dy * dy > reach_m * reach_m) return;
  touch_bar(n, in_body(n, ball.position));
  touch_ball_with_hull(h.outline, states[n], h.restitution, h.friction, static_cast<int>(n));
}

void World::Impl::touch_ball_with_walls() {
  const FieldSize& field = *options.field;
  const double out_m = field.boundary_mm / 1000.0, r_m = options.ball.radius_m;
  const auto put = [&](const Vector3& normal, double depth_m) {
    Contact contact;
    contact.a = body_of_ball();
    contact.b = ContactSolver::kFixed;
    contact.normal = normal;
    contact.point = ball.position - r_m * normal;
    contact.restitution = options.wall_restitution;
    contact.friction = options.wall_friction;
    solver.touch(contact);
    overlaps.push_back({kBallWho, -1, normal, depth_m});
  };
  const Vector3& p = ball.position;
  const double x_m = field.half_length_m() + out_m, y_m = field.half_width_m() + out_m;
  if (p.z() < kBoardHeight_m) {
    // A ball that flew over a board stays outside.
    if (std::abs(p.x()) > x_m - r_m && std::abs(p.x()) < x_m)
      put({p.x() > 0 ? -1.0 : 1.0, 0, 0}, std::abs(p.x()) - x_m + r_m);
    if (std::abs(p.y()) > y_m - r_m && std::abs(p.y()) < y_m)
      put({0, p.y() > 0 ? -1.0 : 1.0, 0}, std::abs(p.y()) - y_m + r_m);
  }
  if (std::abs(p.x()) < field.half_length_m() - r_m) return;
  for (const Board& board : boards) {
    const Vector3 next(std::clamp(p.x(), board.x_from_m, board.x_to_m),
                       std::clamp(p.y(), board.y_from_m, board.y_to_m), std::min(p.z(), board.height_m));
    const Vector3 way = p - next;
    const double distance_m = way.norm();
    if (distance_m < r_m && distance_m > 1e-9) put(way / distance_m, r_m - distance_m);
  }
}

void World::Impl::give_back() {
  for (std::size_t n = 0; n < parts.size(); ++n) {
    if (roller[n] >= 0) handling[n].omega_bar_rad_s = solver.roller(roller[n]).omega_rad_s;
    if (body[n] < 0) continue;
    const ContactBody& b = solver.body(body[n]);
    const PlanarState& s = states[n];
    const Vector3 com = b.center - Vector3(s.x_m, s.y_m, 0.0);
    const Vector3 centre = b.velocity - b.spin.cross(com);
    plant.add_velocity(static_cast<int>(n), centre.x() - s.v_x_m_s, centre.y() - s.v_y_m_s,
                       b.spin.z() - s.omega_rad_s);
  }
  if (ball_body < 0) return;
  const ContactBody& b = solver.body(ball_body);
  ball.velocity = b.velocity;
  ball.spin = b.spin;
  const double up_m_s = ball.velocity.z();
  if (!ball.on_floor) return;
  ball.on_floor = up_m_s * up_m_s <= 2.0 * kGravity_m_s2 * kLeastBounce_m || up_m_s < 0.0;
  if (ball.on_floor) ball.velocity.z() = 0.0;
}

// Positions only: each pair by the masses, the ball before a robot, a robot before a wall.
void World::Impl::move_apart() {
  for (int round = 0; round < kMendRounds; ++round) {
    for (Overlap& o : overlaps) {
      const double by_m = kMendRatio * (o.depth_m - kSlop_m);
      if (by_m <= 0.0) continue;
      const auto per_mass = [&](int who) {
        if (who == kBallWho) return 1.0 / options.ball.mass_kg;
        return who < 0 ? 0.0 : 1.0 / parts[static_cast<std::size_t>(who)].mass_kg;
      };
      const double all = per_mass(o.a) + per_mass(o.b);
      const auto move = [&](int who, double way_m) {
        if (who == kBallWho) {
          ball.position += way_m * o.normal;
          ball.position.z() = std::max(ball.position.z(), options.ball.radius_m);
        } else if (who >= 0) {
          plant.shift(who, way_m * o.normal.x(), way_m * o.normal.y());
        }
      };
      move(o.a, by_m * per_mass(o.a) / all);
      move(o.b, -by_m * per_mass(o.b) / all);
      o.depth_m -= by_m;
    }
    if (overlaps.size() < 2) break;  // others may have been pushed together: look again
  }
}

void World::Impl::touch_all(double step_s) {
  solver.clear();
  overlaps.clear();
  touching.clear();
  std::ranges::fill(body, -1);
  std::ranges::fill(roller, -1);
  std::ranges::fill(shape_known, 0);
  for (std::size_t m = 0; m < movers.size(); ++m) {
    const PlanarState& s = movers[m].state;
    mover_shapes[m] = robot_shape(movers[m].outline, s.x_m, s.y_m, s.yaw_rad);
    mover_body[m] = -1;
  }
  ball_body = -1;
  const std::size_t count = parts.size();
  for (std::size_t a = 0; a < count; ++a) {
    if (!here[a]) continue;
    if (options.contacts)
      for (std::size_t b = a + 1; b < count; ++b)
        if (here[b]) touch_robots(a, b);
    if (options.field != nullptr && options.contacts) touch_walls(a);
    if (options.contacts)
      for (std::size_t m = 0; m < movers.size(); ++m) touch_robot_with_mover(a, m);
    if (has_ball) touch_ball_with_robot(a);
  }
  if (has_ball)
    for (std::size_t m = 0; m < movers.size(); ++m) touch_ball_with_mover(m);
  if (has_ball && options.field != nullptr) touch_ball_with_walls();
  if (solver.empty()) {
    touched_before.clear();
    return;
  }
  if (ball_body >= 0 && ball.on_floor) {
    Contact floor;
    floor.a = ball_body;
    floor.b = ContactSolver::kFixed;
    floor.point = ball.position - Vector3(0, 0, options.ball.radius_m);
    floor.friction = options.carpet.at(ball.position.x(), ball.position.y()).sliding_friction;
    solver.touch(floor);
  }
  solver.solve(step_s);
  give_back();
  move_apart();
  for (const auto& pair : touching) {
    if (std::ranges::find(touched_before, pair) != touched_before.end()) continue;
    const auto at = static_cast<std::size_t>(pair.first);
    if (pair.second == kBallWho)
      report(WorldEventKind::kBallTouch, pair.first, -1, ball.position.x(), ball.position.y(), 0.0);
    else
      report(WorldEventKind::kRobotsTouch, pair.first, std::max(pair.second, -1), states[at].x_m,
             states[at].y_m, 0.0);
  }
  touched_before = touching;
}

}  // namespace omnihil
