#include "sim/law/drive_params.h"

namespace omnihil {
namespace {

#define DRIVE_PATH(path, linear_path, member) \
  { path, linear_path, &DriveParams<double>::member, &DriveParams<Jet>::member }

constexpr DriveParamPath kPaths[] = {
    DRIVE_PATH("motor.resistance_ohm", "motor.resistance_ohm", resistance_ohm),
    DRIVE_PATH("motor.inductance_H", "motor.inductance_H", inductance_H),
    DRIVE_PATH("motor.torque_constant_Nm_per_A", "motor.torque_constant_N_per_A", torque_constant_Nm_per_A),
    DRIVE_PATH("motor.rotor_inertia_kg_m2", "", rotor_inertia_kg_m2),
    DRIVE_PATH("motor.viscous_friction_Nm_s_per_rad", "motor.viscous_friction_N_s_per_m",
               viscous_friction_Nm_s_per_rad),
    DRIVE_PATH("motor.current_limit_A", "", current_limit_A),
    DRIVE_PATH("motor.duty_limit_ratio", "", duty_limit_ratio),
    DRIVE_PATH("gear.ratio", "", gear_ratio),
    DRIVE_PATH("load.inertia_kg_m2", "load.mass_kg", load_inertia_kg_m2),
    DRIVE_PATH("load.gravity_torque_Nm", "", gravity_torque_Nm),
    DRIVE_PATH("supply.voltage_V", "supply.voltage_V", supply_voltage_V),
    DRIVE_PATH("drive.pwm_frequency_Hz", "drive.pwm_frequency_Hz", pwm_frequency_Hz),
    DRIVE_PATH("servo.kp_duty_per_rad", "", servo_kp_duty_per_rad),
    DRIVE_PATH("servo.duty_limit", "", servo_duty_limit_ratio),
};
#undef DRIVE_PATH

}  // namespace

std::span<const DriveParamPath> drive_param_paths() { return kPaths; }

}  // namespace omnihil
