// Movers: held bodies that robots and the ball run into; world.h says what they are for.
#include "sim/field/world_impl.h"

namespace omnihil {

void World::set_movers(std::span<const Mover> movers) {
  impl_->movers.assign(movers.begin(), movers.end());
  impl_->mover_shapes.resize(movers.size());
  impl_->mover_body.resize(movers.size());
}
std::span<const Mover> World::movers() const { return impl_->movers; }

int World::Impl::body_of_mover(std::size_t m) {
  if (mover_body[m] >= 0) return mover_body[m];
  const PlanarState& s = movers[m].state;
  ContactBody held;
  held.center = {s.x_m, s.y_m, 0.0};
  held.velocity = {s.v_x_m_s, s.v_y_m_s, 0.0};
  held.spin = {0.0, 0.0, s.omega_rad_s};
  mover_body[m] = solver.add(held);
  return mover_body[m];
}

void World::Impl::touch_robot_with_mover(std::size_t n, std::size_t m) {
  const PlanarState& s = movers[m].state;
  const double dx = s.x_m - states[n].x_m, dy = s.y_m - states[n].y_m;
  const double reach_m = parts[n].handling->outline.radius_m + movers[m].outline.radius_m;
  if (dx * dx + dy * dy > reach_m * reach_m) return;
  const Touch touch = touch_of(mover_shapes[m], shape_of(n));
  if (touch.depth_m <= 0.0) return;
  const int who = kFirstMover - static_cast<int>(m);
  put_touch(touch, body_of(n), body_of_mover(m), static_cast<int>(n), who);
}

void World::Impl::touch_ball_with_mover(std::size_t m) {
  const PlanarState& s = movers[m].state;
  const double dx = ball.position.x() - s.x_m, dy = ball.position.y() - s.y_m;
  const double reach_m = movers[m].outline.radius_m + 2.0 * options.ball.radius_m;
  if (dx * dx + dy * dy > reach_m * reach_m) return;
  // A hull like our own robots'; what it is made of vision does not tell.
  const BallHandling usual;
  touch_ball_with_hull(movers[m].outline, s, usual.restitution, usual.friction,
                       kFirstMover - static_cast<int>(m));
}

}  // namespace omnihil
