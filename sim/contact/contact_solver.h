// Impulses of bodies that touch, all at once: ball, robots, what stands still, and rollers that turn.
//
//   ContactSolver solver;
//   const int robot = solver.add(planar_contact_body(2.5, 0.0115, {0, 0}, {1, 0}, 0.0));
//   solver.touch({.a = robot, .b = ContactSolver::kFixed, .point = {0.09, 0, 0.02}, .normal = {-1, 0, 0},
//                 .restitution = 0.3, .friction = 0.4});
//   solver.solve(0.0005);
//   solver.body(robot).velocity;                          // after
//
// Law, per contact with impulse j >= 0 along n (from b to a) and friction f across it, both on a, opposite on b:
//   v_n' = -e v_n where they met faster than the floor of restitution, else v_n' >= 0;   j (v_n' + e v_n) = 0
//   |f| <= mu j, against the slip; what stops the slip if that is less          (Coulomb)
// Solved by projected Gauss-Seidel (sequential impulses; Catto 2005, "Iterative dynamics with temporal coherence").
// A soft contact has a spring and a damper behind its surface, implicit in the step (Catto 2011, "Soft constraints"):
//   j = h (k (depth - h v_n') - c v_n') >= 0
// A roller is a body that turns about one axis fixed in a robot and feels friction only (dribbler).
// Newton's restitution with friction at several points can create energy (Kane 1984): where it would, and nothing soft
// or driven is in it, all velocities go back along the straight line to where the energy is what it was.
// Planar bodies (robots) take no vertical impulse and do not tip: the floor gives what they need.
// Cannot: waves of impact (a row of balls), deformation, the order of simultaneous impacts.
#pragma once
#include <span>
#include <vector>

#include "sim/contact/ball.h"
#include "sim/contact/convex_shape.h"

namespace omnihil {

struct ContactBody {
  Vector3 center{0, 0, 0};  // of mass
  Vector3 velocity{0, 0, 0}, spin{0, 0, 0};
  Vector3 per_mass{0, 0, 0}, per_inertia{0, 0, 0};  // 1/kg, 1/(kg m2), along the field's axes; 0: held
};

// center: centre of mass, velocity of it; inertia about it.
ContactBody planar_contact_body(double mass_kg, double inertia_kg_m2, const Vector2& center,
                                const Vector2& velocity, double omega_rad_s);
ContactBody ball_contact_body(const BallParams& params, const BallState& ball);

struct Roller {
  Vector3 axis{0, 1, 0};  // field frame
  double radius_m = 0.0;
  double per_inertia = 0.0;  // 1/(kg m2)
  double omega_rad_s = 0.0;
};

struct Contact {
  int a = 0, b = -1;
  Vector3 point{0, 0, 0}, normal{0, 0, 1};  // field frame; from b to a
  double restitution = 0.0, friction = 0.0;
  double least_bounce_m_s = 0.05;  // met slower than that: no bounce
  int roller = -1;                 // of b's side: its surface moves
  double stiffness_N_per_m = 0.0;  // 0: hard
  double damping_N_s_per_m = 0.0;
  double depth_m = 0.0;  // of a soft one
  // found
  double impulse_Ns = 0.0;
  Vector3 friction_Ns{0, 0, 0};
};

class ContactSolver {
 public:
  static constexpr int kFixed = -1;

  void clear();
  int add(const ContactBody& body);
  int add(const Roller& roller);
  void touch(const Contact& contact);
  void solve(double step_s);

  const ContactBody& body(int index) const { return bodies_[static_cast<std::size_t>(index)]; }
  const Roller& roller(int index) const { return rollers_[static_cast<std::size_t>(index)]; }
  std::span<const Contact> contacts() const { return contacts_; }
  double kinetic_energy_J() const;
  bool empty() const { return contacts_.empty(); }

 private:
  struct Row {
    Vector3 arm_a, arm_b, arm_roller;
    double normal_mass_kg, tangent_mass_kg;
    double wanted_m_s;      // normal speed after
    double softness = 0.0;  // m/s per N s
  };
  Vector3 speed_at(const Contact& c, const Row& row) const;  // of a against b
  void push(const Contact& c, const Row& row, const Vector3& impulse_Ns);
  Row row_of(const Contact& c, double step_s) const;
  void limit_energy(double before_J);

  std::vector<ContactBody> bodies_, before_;
  std::vector<Roller> rollers_;
  std::vector<Contact> contacts_;
  std::vector<Row> rows_;
};

}  // namespace omnihil
