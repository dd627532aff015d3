// Kicker, capacitor, dribbler motor and break beam of one robot, once a mechanical step.
#include <algorithm>
#include <cmath>

#include "sim/field/chip_kick.h"
#include "sim/field/dribbler.h"
#include "sim/field/kicker.h"
#include "sim/field/world_impl.h"
#include "sim/law/random.h"

namespace omnihil {
namespace {
constexpr double kPlungerOut_s = 2e-3;  // at least so long the plunger takes a ball that comes
}

Vector3 World::Impl::in_body(std::size_t n, const Vector3& p) const {
  const double c = std::cos(states[n].yaw_rad), s = std::sin(states[n].yaw_rad);
  const double x_m = p.x() - states[n].x_m, y_m = p.y() - states[n].y_m;
  return {c * x_m + s * y_m, -s * x_m + c * y_m, p.z()};
}

void World::Impl::begin_kick(std::size_t n, const RobotDrive& drive) {
  HandlingState& h = handling[n];
  const bool asked = drive.kick != OMNIHIL_KICK_NONE;
  const bool begins = asked && !h.kick_asked;
  h.kick_asked = asked;
  if (!begins) return;
  const BallHandling& part = *parts[n].handling;
  const double charge_ratio = h.capacitor_V / part.capacitor.full_V;
  const double flat_m_s = kick_speed_m_s(part.kick, drive.kick_pulse_s, charge_ratio);
  h.capacitor_V = voltage_after_kick_V(part.capacitor, h.capacitor_V, options.ball.mass_kg, flat_m_s);
  h.chips = drive.kick == OMNIHIL_KICK_CHIP;
  h.kick_k = charge_ratio * kick_power(part.kick, drive.kick_pulse_s);
  h.kick_speed_m_s = flat_m_s;
  h.kick_angle_rad = 0.0;
  h.kick_until_s = flat_m_s > 0.0 ? now_s() + std::max(drive.kick_pulse_s, kPlungerOut_s) : -1.0;
}

// The ball leaves at its speed relative to the plunger; the robot has the recoil.
void World::Impl::kick_ball(std::size_t n) {
  HandlingState& h = handling[n];
  const BallHandling& part = *parts[n].handling;
  const Vector3 at = in_body(n, ball.position);
  const double gap_m = at.x() - part.outline.front_m - options.ball.radius_m;
  const bool reached = gap_m <= part.kick_reach_m && at.x() > part.outline.front_m &&
                       std::abs(at.y()) <= part.kick_half_width_m && at.z() <= 2.0 * options.ball.radius_m;
  if (!reached) return;
  h.kick_until_s = -1.0;
  if (h.chips) {
    const ChipKick chip = chip_kick(part.chip, h.kick_k, at.y());
    h.kick_speed_m_s = chip.speed_m_s;
    h.kick_angle_rad = chip.angle_rad;
  }
  const PlanarState& s = states[n];
  const double c = std::cos(s.yaw_rad), sn = std::sin(s.yaw_rad);
  const Vector3 arm(ball.position.x() - s.x_m, ball.position.y() - s.y_m, 0.0);
  const Vector3 plunger = Vector3(s.v_x_m_s, s.v_y_m_s, 0.0) + Vector3(0, 0, s.omega_rad_s).cross(arm);
  const double flat_m_s = h.kick_speed_m_s * std::cos(h.kick_angle_rad);
  const double up_m_s = h.kick_speed_m_s * std::sin(h.kick_angle_rad);
  const Vector3 after = plunger + Vector3(c * flat_m_s, sn * flat_m_s, up_m_s);
  const Vector3 impulse_Ns = options.ball.mass_kg * (after - ball.velocity);
  ball.velocity = after;
  ball.on_floor = ball.on_floor && up_m_s <= 0.0;
  const Part& body_part = parts[n];
  const Vector3 com(c * body_part.com.x() - sn * body_part.com.y(),
                    sn * body_part.com.x() + c * body_part.com.y(), 0.0);
  const double turn = -(arm - com).cross(impulse_Ns).z() / body_part.inertia_kg_m2;
  const Vector3 centre = -impulse_Ns / body_part.mass_kg - Vector3(0, 0, turn).cross(com);
  plant.add_velocity(static_cast<int>(n), centre.x(), centre.y(), turn);
  states[n] = plant.planar_state(static_cast<int>(n));
  report(WorldEventKind::kKick, static_cast<int>(n), -1, ball.position.x(), ball.position.y(),
         h.kick_speed_m_s);
}

void World::Impl::handle_ball(std::size_t n, double step_s) {
  HandlingState& h = handling[n];
  const BallHandling& part = *parts[n].handling;
  const RobotDrive& drive = drives[n];
  const bool idle = drive.charge == 0u && drive.dribbler_ratio == 0.0 && h.omega_bar_rad_s == 0.0;
  if (!idle) {
    const double bus_V = models[n].bus_voltage_V;
    double other_A = 0.0;
    if (drive.charge != 0u)
      other_A += charge_capacitor(part.capacitor, h.capacitor_V, bus_V, step_s).bus_current_A;
    const DribblerStep bar = drive_bar(part.dribbler, h.omega_bar_rad_s, drive.dribbler_ratio, bus_V, step_s);
    h.omega_bar_rad_s = bar.omega_bar_rad_s;
    h.dribbler_current_A = bar.motor_current_A;
    plant.set_other_current(static_cast<int>(n), other_A + bar.bus_current_A);
  } else if (h.dribbler_current_A != 0.0) {
    h.dribbler_current_A = 0.0;
    plant.set_other_current(static_cast<int>(n), 0.0);
  }
  if (!has_ball || !here[n]) {
    h.ball_seen = beam_seen(
        part.beam, h.beam, false, now_s(), step_s,
        uniform(plant.options().seed, stream_of("break_beam") + n, static_cast<std::uint64_t>(steps)));
    return;
  }
  const double far_m = part.outline.radius_m + part.beam.forward_m + 2.0 * options.ball.radius_m;
  const double dx = ball.position.x() - states[n].x_m, dy = ball.position.y() - states[n].y_m;
  const bool near = dx * dx + dy * dy < far_m * far_m;
  const bool cut =
      near && beam_cut(part.beam, part.outline, in_body(n, ball.position), options.ball.radius_m);
  h.ball_seen = beam_seen(
      part.beam, h.beam, cut, now_s(), step_s,
      part.beam.false_rate_Hz > 0.0
          ? uniform(plant.options().seed, stream_of("break_beam") + n, static_cast<std::uint64_t>(steps))
          : 1.0);
  if (h.kick_until_s >= now_s()) kick_ball(n);
}

}  // namespace omnihil
