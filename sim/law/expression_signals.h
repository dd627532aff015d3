// What a user's formula may read and what it may add to, per place: the fields of the ports, by name.
//
//   for (const auto& s : PortTable<TorquePort<double>>::kSignals) std::cout << s.name << " " << s.unit;
//   // omega_rotor_rad_s rad/s, …
//
// Fields mean what sim/law/effect_ports.h says of them.
#pragma once
#include <string_view>

#include "sim/law/effect.h"
#include "sim/law/effect_ports.h"

namespace omnihil {

template <typename T, typename Port>
struct PortSignal {
  std::string_view name;
  std::string_view unit;
  T Port::*value = nullptr;
  int Port::*whole = nullptr;  // where the field is a whole number

  T read(const Port& port) const { return value != nullptr ? port.*value : T(port.*whole); }
};

template <typename T, typename Port>
struct PortTarget {
  std::string_view name;
  std::string_view unit;
  T Port::*field;
  T Port::*also = nullptr;  // a second field that gets the same
  bool level = false;       // never negative: nothing is added where the formula is
};

template <typename Port>
struct PortTable;

template <typename T>
struct PortTable<CommandPort<T>> {
  using P = CommandPort<T>;
  static constexpr Place kPlace = Place::kCommand;
  static constexpr PortSignal<T, P> kSignals[] = {
      {"setpoint", "of the command", &P::setpoint},
      {"position_rad", "rad", &P::position_rad},
  };
  static constexpr PortTarget<T, P> kTargets[] = {{"setpoint", "of the command", &P::setpoint}};
};

template <typename T>
struct PortTable<SupplyPort<T>> {
  using P = SupplyPort<T>;
  static constexpr Place kPlace = Place::kSupply;
  static constexpr PortSignal<T, P> kSignals[] = {
      {"bus_current_A", "A", &P::bus_current_A},
      {"bus_voltage_V", "V", &P::bus_voltage_V},
  };
  static constexpr PortTarget<T, P> kTargets[] = {{"bus_voltage_V", "V", &P::bus_voltage_V}};
};

template <typename T>
struct PortTable<BridgePort<T>> {
  using P = BridgePort<T>;
  static constexpr Place kPlace = Place::kBridge;
  static constexpr PortSignal<T, P> kSignals[] = {
      {"duty_ratio", "1", &P::duty_ratio},
      {"bus_voltage_V", "V", &P::bus_voltage_V},
      {"current_A", "A", &P::current_A},
      {"back_emf_V", "V", &P::back_emf_V},
      {"temperature_rise_K", "K", &P::temperature_rise_K},
      {"pwm_frequency_Hz", "Hz", &P::pwm_frequency_Hz},
  };
  static constexpr PortTarget<T, P> kTargets[] = {{"voltage_V", "V", &P::voltage_V}};
};

template <typename T>
struct PortTable<WindingPort<T>> {
  using P = WindingPort<T>;
  static constexpr Place kPlace = Place::kWinding;
  static constexpr PortSignal<T, P> kSignals[] = {
      {"current_A", "A", &P::current_A},
      {"omega_rotor_rad_s", "rad/s", &P::omega_rotor_rad_s},
      {"theta_rotor_rad", "rad", &P::theta_rotor_rad},
      {"temperature_rise_K", "K", &P::temperature_rise_K},
      {"wheel", "1", nullptr, &P::wheel},
  };
  static constexpr PortTarget<T, P> kTargets[] = {
      {"resistance_ohm", "ohm", &P::resistance_ohm},
      {"inductance_H", "H", &P::inductance_H},
      {"torque_constant_Nm_per_A", "N m/A", &P::torque_constant_Nm_per_A, &P::back_emf_V_s_per_rad},
      {"back_emf_offset_V", "V", &P::back_emf_offset_V},
  };
};

template <typename T>
struct PortTable<TorquePort<T>> {
  using P = TorquePort<T>;
  static constexpr Place kPlace = Place::kTorque;
  static constexpr PortSignal<T, P> kSignals[] = {
      {"omega_rotor_rad_s", "rad/s", &P::omega_rotor_rad_s},
      {"theta_rotor_rad", "rad", &P::theta_rotor_rad},
      {"omega_output_rad_s", "rad/s", &P::omega_output_rad_s},
      {"theta_output_rad", "rad", &P::theta_output_rad},
      {"tau_motor_Nm", "N m", &P::tau_motor_Nm},
      {"tau_load_Nm", "N m", &P::tau_load_Nm},
      {"gear_ratio", "1", &P::gear_ratio},
      {"inertia_kg_m2", "kg m2", &P::inertia_kg_m2},
  };
  static constexpr PortTarget<T, P> kTargets[] = {
      {"torque_Nm", "N m", &P::tau_Nm},
      {"friction_torque_Nm", "N m", &P::friction_positive_Nm, &P::friction_negative_Nm, true},
      {"viscous_friction_Nm_s_per_rad", "N m s/rad", &P::viscous_positive_Nm_s_per_rad,
       &P::viscous_negative_Nm_s_per_rad, true},
  };
};

template <typename T>
struct PortTable<ContactPort<T>> {
  using P = ContactPort<T>;
  static constexpr Place kPlace = Place::kContact;
  static constexpr PortSignal<T, P> kSignals[] = {
      {"omega_wheel_rad_s", "rad/s", &P::omega_wheel_rad_s},
      {"theta_wheel_rad", "rad", &P::theta_wheel_rad},
      {"v_longitudinal_m_s", "m/s", &P::v_longitudinal_m_s},
      {"v_lateral_m_s", "m/s", &P::v_lateral_m_s},
      {"load_N", "N", &P::load_N},
      {"wheel", "1", nullptr, &P::wheel},
  };
  static constexpr PortTarget<T, P> kTargets[] = {
      {"force_longitudinal_N", "N", &P::force_longitudinal_N},
      {"force_lateral_N", "N", &P::force_lateral_N},
      {"friction_wheel_Nm", "N m", &P::friction_wheel_Nm, nullptr, true},
  };
};

template <typename T>
struct PortTable<BodyPort<T>> {
  using P = BodyPort<T>;
  static constexpr Place kPlace = Place::kBody;
  static constexpr PortSignal<T, P> kSignals[] = {
      {"v_forward_m_s", "m/s", &P::v_forward_m_s},         {"v_left_m_s", "m/s", &P::v_left_m_s},
      {"omega_body_rad_s", "rad/s", &P::omega_body_rad_s}, {"yaw_rad", "rad", &P::yaw_rad},
      {"dribbler_rad_s", "rad/s", &P::dribbler_rad_s},
  };
  static constexpr PortTarget<T, P> kTargets[] = {
      {"force_x_N", "N", &P::force_x_N},
      {"force_y_N", "N", &P::force_y_N},
      {"torque_z_Nm", "N m", &P::torque_z_Nm},
  };
};

template <typename T>
struct PortTable<SensorPort<T>> {
  using P = SensorPort<T>;
  static constexpr Place kPlace = Place::kSensor;
  static constexpr PortSignal<T, P> kSignals[] = {
      {"theta_rotor_rad", "rad", &P::theta_rotor_rad},
      {"omega_rotor_rad_s", "rad/s", &P::omega_rotor_rad_s},
  };
  static constexpr PortTarget<T, P> kTargets[] = {
      {"encoder_angle_rad", "rad", &P::encoder_angle_rad},
      {"measured_speed_rad_s", "rad/s", &P::measured_speed_rad_s},
  };
};

}  // namespace omnihil
