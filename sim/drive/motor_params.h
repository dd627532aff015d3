// Parameters of one drive (DC-equivalent of a brushless motor) and its encoder. SI, rotor side.
#pragma once
#include <cstdint>
#include <string>

namespace omnihil {

struct MotorParams {
  std::string name;
  double resistance_ohm = 0.0;            // terminal, phase to phase
  double inductance_H = 0.0;              // terminal, phase to phase
  double torque_constant_Nm_per_A = 0.0;  // equals the back-EMF constant in V s/rad
  double rotor_inertia_kg_m2 = 0.0;
  double viscous_friction_Nm_s_per_rad = 0.0;
  double coulomb_friction_Nm = 0.0;  // really holds still below this torque
  double current_limit_A = 0.0;      // supply or bridge limit; 0: none
  double duty_limit_ratio = 1.0;
  int pole_pairs = 0;  // 0: unknown
};

struct EncoderParams {
  int counts_per_turn = 0;      // after quadrature, per rotor turn
  int direction = 1;            // +1 or -1: sign of counts for positive rotation
  int index_offset_counts = 0;  // position of the index pulse within a turn
};

}  // namespace omnihil
