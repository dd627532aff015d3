#include "sim/contact/contact_solver.h"

#include <algorithm>
#include <cmath>

namespace omnihil {
namespace {

constexpr int kRounds = 30;             // a ball between two robots: within 1 % after 20
constexpr double kConverged_Ns = 1e-9;  // 20 nm/s of the ball

// Mass that an impulse along n at the arm feels, inverse.
double per_mass_along(const ContactBody& body, const Vector3& arm, const Vector3& n) {
  const Vector3 turn = arm.cross(n);
  return n.cwiseProduct(body.per_mass).dot(n) + turn.cwiseProduct(body.per_inertia).dot(turn);
}

// The largest along any direction across n: two of its axes and what couples them.
double per_mass_across(const ContactBody& body, const Vector3& arm, const Vector3& s, const Vector3& t) {
  return std::max(per_mass_along(body, arm, s), per_mass_along(body, arm, t)) +
         std::abs(s.cwiseProduct(body.per_mass).dot(t) +
                  arm.cross(s).cwiseProduct(body.per_inertia).dot(arm.cross(t)));
}

double kinetic_of(const ContactBody& b) {
  double twice_J = 0.0;
  for (int i = 0; i < 3; ++i) {
    if (b.per_mass[i] > 0.0) twice_J += b.velocity[i] * b.velocity[i] / b.per_mass[i];
    if (b.per_inertia[i] > 0.0) twice_J += b.spin[i] * b.spin[i] / b.per_inertia[i];
  }
  return 0.5 * twice_J;
}

// A body that goes its way whatever is put on it can do work.
bool moves_held(const ContactBody& b) {
  return b.per_mass.isZero() && b.per_inertia.isZero() && !(b.velocity.isZero() && b.spin.isZero());
}

}  // namespace

ContactBody planar_contact_body(double mass_kg, double inertia_kg_m2, const Vector2& center,
                                const Vector2& velocity, double omega_rad_s) {
  ContactBody b;
  b.center = {center.x(), center.y(), 0.0};
  b.velocity = {velocity.x(), velocity.y(), 0.0};
  b.spin = {0.0, 0.0, omega_rad_s};
  b.per_mass = {1.0 / mass_kg, 1.0 / mass_kg, 0.0};
  b.per_inertia = {0.0, 0.0, 1.0 / inertia_kg_m2};
  return b;
}

ContactBody ball_contact_body(const BallParams& params, const BallState& ball) {
  ContactBody b;
  b.center = ball.position;
  b.velocity = ball.velocity;
  b.spin = ball.spin;
  b.per_mass.setConstant(1.0 / params.mass_kg);
  b.per_inertia.setConstant(1.0 / params.inertia_kg_m2());
  return b;
}

void ContactSolver::clear() {
  bodies_.clear();
  rollers_.clear();
  contacts_.clear();
}
int ContactSolver::add(const ContactBody& body) {
  bodies_.push_back(body);
  return static_cast<int>(bodies_.size()) - 1;
}
int ContactSolver::add(const Roller& roller) {
  rollers_.push_back(roller);
  return static_cast<int>(rollers_.size()) - 1;
}
void ContactSolver::touch(const Contact& contact) { contacts_.push_back(contact); }

double ContactSolver::kinetic_energy_J() const {
  double sum_J = 0.0;
  for (const ContactBody& b : bodies_) sum_J += kinetic_of(b);
  for (const Roller& r : rollers_)
    if (r.per_inertia > 0.0) sum_J += 0.5 * r.omega_rad_s * r.omega_rad_s / r.per_inertia;
  return sum_J;
}

Vector3 ContactSolver::speed_at(const Contact& c, const Row& row) const {
  const ContactBody& a = bodies_[static_cast<std::size_t>(c.a)];
  Vector3 v = a.velocity + a.spin.cross(row.arm_a);
  if (c.b >= 0) {
    const ContactBody& b = bodies_[static_cast<std::size_t>(c.b)];
    v -= b.velocity + b.spin.cross(row.arm_b);
  }
  if (c.roller >= 0) {
    const Roller& r = rollers_[static_cast<std::size_t>(c.roller)];
    v -= r.omega_rad_s * r.axis.cross(row.arm_roller);
  }
  return v;
}

void ContactSolver::push(const Contact& c, const Row& row, const Vector3& j) {
  ContactBody& a = bodies_[static_cast<std::size_t>(c.a)];
  a.velocity += a.per_mass.cwiseProduct(j);
  a.spin += a.per_inertia.cwiseProduct(row.arm_a.cross(j));
  if (c.b >= 0) {
    ContactBody& b = bodies_[static_cast<std::size_t>(c.b)];
    b.velocity -= b.per_mass.cwiseProduct(j);
    b.spin -= b.per_inertia.cwiseProduct(row.arm_b.cross(j));
  }
  if (c.roller >= 0) {
    Roller& r = rollers_[static_cast<std::size_t>(c.roller)];
    r.omega_rad_s -= r.per_inertia * r.axis.dot(row.arm_roller.cross(j));
  }
}

ContactSolver::Row ContactSolver::row_of(const Contact& c, double step_s) const {
  Row row;
  const Vector3 s = c.normal.unitOrthogonal(), t = c.normal.cross(s);
  const ContactBody& a = bodies_[static_cast<std::size_t>(c.a)];
  row.arm_a = c.point - a.center;
  row.arm_b.setZero();
  row.arm_roller.setZero();
  double normal = per_mass_along(a, row.arm_a, c.normal), tangent = per_mass_across(a, row.arm_a, s, t);
  if (c.b >= 0) {
    const ContactBody& b = bodies_[static_cast<std::size_t>(c.b)];
    row.arm_b = c.point - b.center;
    normal += per_mass_along(b, row.arm_b, c.normal);
    tangent += per_mass_across(b, row.arm_b, s, t);
  }
  if (c.roller >= 0) {
    const Roller& r = rollers_[static_cast<std::size_t>(c.roller)];
    row.arm_roller = r.radius_m * c.normal;
    tangent += r.per_inertia * r.radius_m * r.radius_m;
  }
  const double met_m_s = speed_at(c, row).dot(c.normal);
  row.wanted_m_s = met_m_s < -c.least_bounce_m_s ? -c.restitution * met_m_s : 0.0;
  if (c.stiffness_N_per_m > 0.0) {
    const double k = c.stiffness_N_per_m, d = c.damping_N_s_per_m;
    row.softness = 1.0 / (step_s * (d + step_s * k));
    row.wanted_m_s = k * c.depth_m / (d + step_s * k);
  }
  row.normal_mass_kg = 1.0 / (normal + row.softness);
  row.tangent_mass_kg = 1.0 / tangent;
  return row;
}

void ContactSolver::solve(double step_s) {
  if (contacts_.empty()) return;
  rows_.clear();
  bool passive = true;
  for (const Contact& c : contacts_) {
    rows_.push_back(row_of(c, step_s));
    passive = passive && c.roller < 0 && c.stiffness_N_per_m == 0.0 && !(c.b >= 0 && moves_held(body(c.b)));
  }
  before_ = bodies_;
  const double before_J = passive ? kinetic_energy_J() : 0.0;
  for (int round = 0; round < kRounds; ++round) {
    double most_Ns = 0.0;
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
      Contact& c = contacts_[i];
      const Row& row = rows_[i];
      const double v_n = speed_at(c, row).dot(c.normal);
      const double next_Ns = std::max(
          0.0, c.impulse_Ns + row.normal_mass_kg * (row.wanted_m_s - v_n - row.softness * c.impulse_Ns));
      const double change_Ns = next_Ns - c.impulse_Ns;
      c.impulse_Ns = next_Ns;
      push(c, row, change_Ns * c.normal);
      most_Ns = std::max(most_Ns, std::abs(change_Ns));
      if (!(c.friction > 0.0)) continue;
      const Vector3 v = speed_at(c, row);
      const Vector3 slip = v - v.dot(c.normal) * c.normal;
      Vector3 next = c.friction_Ns - row.tangent_mass_kg * slip;
      const double limit_Ns = c.friction * c.impulse_Ns, size_Ns = next.norm();
      if (size_Ns > limit_Ns) next *= limit_Ns / size_Ns;
      const Vector3 across = next - c.friction_Ns;
      c.friction_Ns = next;
      push(c, row, across);
      most_Ns = std::max(most_Ns, across.norm());
    }
    if (most_Ns < kConverged_Ns) break;
  }
  if (passive) limit_energy(before_J);
}

// E((1 - s) v0 + s v1) is a parabola E0 + B s + A s^2: with E1 > E0 it meets E0 again at s = -B / A.
void ContactSolver::limit_energy(double before_J) {
  const double after_J = kinetic_energy_J();
  if (after_J <= before_J) return;
  std::vector<ContactBody> change = bodies_;
  double change_J = 0.0;  // A: the energy of the change
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    change[i].velocity -= before_[i].velocity;
    change[i].spin -= before_[i].spin;
    change_J += kinetic_of(change[i]);
  }
  if (!(change_J > 0.0)) return;
  const double linear_J = after_J - before_J - change_J;  // B
  const double share = std::clamp(-linear_J / change_J, 0.0, 1.0);
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    bodies_[i].velocity = before_[i].velocity + share * change[i].velocity;
    bodies_[i].spin = before_[i].spin + share * change[i].spin;
  }
}

}  // namespace omnihil
