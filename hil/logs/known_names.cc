#include "hil/logs/known_names.h"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <span>

#include "identify/record/rig.h"

namespace omnihil {
namespace {

constexpr KnownName kOdrive[] = {
    {"time", "time", "s"},
    {"timestamp", "time", "s"},
    {"vel_estimate", "velocity", "turn/s"},
    {"pos_estimate", "position", "turn"},
    {"Iq_measured", "motor_current", "A"},
    {"vbus_voltage", "bus_voltage", "V"},
    {"bus_voltage", "bus_voltage", "V", 1},
    {"shadow_count", "", "counts", 0, false, "counts of an encoder: --map, with --counts-per-rev"},
    {"effective_torque_setpoint", "motor_torque", "N m"},
    {"torque_setpoint", "motor_torque", "N m", 1},
    {"input_torque", "motor_torque", "N m", 2},
    {"Vq_setpoint", "motor_voltage", "V"},
    {"v_q", "motor_voltage", "V", 1},
    {"Iq_setpoint", "", "A", 0, false, "what the current loop was asked for, not what flowed"},
    {"torque_estimate", "", "N m", 0, false, "reckoned from the current by the controller"},
    {"vel_setpoint", "", "turn/s", 0, false, "target of a loop that the model has not"},
    {"pos_setpoint", "", "turn", 0, false, "target of a loop that the model has not"},
    {"input_vel", "", "turn/s", 0, false, "target of a loop that the model has not"},
    {"input_pos", "", "turn", 0, false, "target of a loop that the model has not"},
    {"ibus", "", "A", 0, false, "current of the supply"}};
constexpr KnownName kMoteus[] = {
    {"time", "time", "s"},
    {"timestamp", "time", "s"},
    {"servo_stats.position", "position", "rev"},
    {"servo_stats.velocity", "velocity", "rev/s"},
    {"servo_stats.velocity_filt", "", "rev/s", 0, false, "filtered by the controller"},
    {"servo_stats.q_A", "motor_current", "A"},
    {"servo_stats.d_A", "", "A", 0, false, "makes no torque"},
    {"servo_stats.filt_bus_V", "bus_voltage", "V"},
    {"servo_stats.bus_V", "bus_voltage", "V", 1},
    {"servo_stats.filt_1ms_bus_V", "bus_voltage", "V", 2},
    {"servo_stats.motor_temp_C", "winding_temperature", "degC"},
    {"servo_stats.torque_Nm", "", "N m", 0, false, "reckoned from the current by the controller"},
    {"servo_control.q_V", "motor_voltage", "V"},
    {"servo_control.torque_Nm", "motor_torque", "N m", 1},
    {"POSITION", "position", "rev"},
    {"VELOCITY", "velocity", "rev/s"},
    {"Q_CURRENT", "motor_current", "A"},
    {"D_CURRENT", "", "A", 0, false, "makes no torque"},
    {"VOLTAGE", "bus_voltage", "V"},
    {"VOLTAGE_DQ_Q", "motor_voltage", "V"},
    {"CONTROL_TORQUE", "motor_torque", "N m"},
    {"TORQUE", "", "N m", 0, false, "reckoned from the current by the controller"},
    {"TEMPERATURE", "", "degC", 0, false, "of the board"},
    {"MOTOR_TEMPERATURE", "winding_temperature", "degC"},
    {"MODE", "", "1", 0, false, "a state"},
    {"FAULT", "", "1", 0, false, "a state"}};
constexpr KnownName kVesc[] = {
    {"ms_today", "time", "ms"},
    {"duty_cycle", "duty", "1"},
    {"input_voltage", "bus_voltage", "V"},
    {"q_axis_current", "motor_current", "A"},
    {"current_motor", "motor_current", "A", 1},
    {"erpm", "velocity", "erpm"},
    {"temp_motor", "winding_temperature", "degC"},
    {"q_axis_voltage", "", "V", 0, false, "follows from duty and supply"},
    {"d_axis_current", "", "A", 0, false, "makes no torque"},
    {"d_axis_voltage", "", "V", 0, false, "makes no torque"},
    {"current_in", "", "A", 0, false, "current of the supply"},
    {"encoder_position", "", "deg", 0, false, "begins anew each turn"},
    {"tachometer", "", "counts", 0, false, "steps of the commutation; erpm is taken"}};
constexpr KnownName kSimpleFoc[] = {
    {"voltage.q [V]", "motor_voltage", "V"},
    {"voltage.d [V]", "", "V", 0, false, "makes no torque"},
    {"current.q [mA]", "motor_current", "mA"},
    {"current.d [mA]", "", "mA", 0, false, "makes no torque"},
    {"velocity [rad/s]", "velocity", "rad/s"},
    {"angle [rad]", "position", "rad"},
    {"target", "", "1", 0, false, "what it is, depends on the motion control"}};

std::span<const KnownName> names_of(LogFormat format) {
  switch (format) {
    case LogFormat::kOdrive:
      return kOdrive;
    case LogFormat::kMoteus:
      return kMoteus;
    case LogFormat::kVesc:
      return kVesc;
    case LogFormat::kSimpleFoc:
      return kSimpleFoc;
    default:
      return {};
  }
}

struct Usual {
  std::string_view name;  // letters and digits, lower case
  std::string_view signal;
};
constexpr Usual kAnyRig[] = {{"t", "time"},
                             {"time", "time"},
                             {"timestamp", "time"},
                             {"zeit", "time"},
                             {"elapsed", "time"},
                             {"busvoltage", "bus_voltage"},
                             {"bus", "bus_voltage"},
                             {"vbus", "bus_voltage"},
                             {"ubus", "bus_voltage"},
                             {"vbat", "bus_voltage"},
                             {"battery", "bus_voltage"},
                             {"batteryvoltage", "bus_voltage"},
                             {"supply", "bus_voltage"},
                             {"vin", "bus_voltage"},
                             {"inputvoltage", "bus_voltage"}};
constexpr Usual kOfAxis[] = {{"duty", "duty"},
                             {"dutycycle", "duty"},
                             {"pwm", "duty"},
                             {"motorpwm", "duty"},
                             {"pwmcmd", "duty"},
                             {"commandedpwm", "duty"},
                             {"pwmcommand", "duty"},
                             {"pwmduty", "duty"},
                             {"motorvoltage", "motor_voltage"},
                             {"appliedvolts", "motor_voltage"},
                             {"appliedvoltage", "motor_voltage"},
                             {"uq", "motor_voltage"},
                             {"vq", "motor_voltage"},
                             {"voltageq", "motor_voltage"},
                             {"vmotor", "motor_voltage"},
                             {"motortorque", "motor_torque"},
                             {"torquesetpoint", "motor_torque"},
                             {"positiontarget", "position_target"},
                             {"postarget", "position_target"},
                             {"posref", "position_target"},
                             {"enable", "enable"},
                             {"enabled", "enable"},
                             {"current", "motor_current"},
                             {"motorcurrent", "motor_current"},
                             {"imotor", "motor_current"},
                             {"iq", "motor_current"},
                             {"statorcurrent", "motor_current"},
                             {"currentq", "motor_current"},
                             {"encoder", "encoder"},
                             {"ticks", "encoder"},
                             {"counts", "encoder"},
                             {"enc", "encoder"},
                             {"encodercounts", "encoder"},
                             {"encodercount", "encoder"},
                             {"encodercnt", "encoder"},
                             {"enccount", "encoder"},
                             {"encoderticks", "encoder"},
                             {"position", "position"},
                             {"angle", "position"},
                             {"theta", "position"},
                             {"pos", "position"},
                             {"angularposition", "position"},
                             {"motorangle", "position"},
                             {"shaftangle", "position"},
                             {"velocity", "velocity"},
                             {"speed", "velocity"},
                             {"omega", "velocity"},
                             {"vel", "velocity"},
                             {"angularvelocity", "velocity"},
                             {"angularspeed", "velocity"},
                             {"motorspeed", "velocity"},
                             {"wheelspeed", "velocity"},
                             {"shaftspeed", "velocity"},
                             {"rpm", "velocity"},
                             {"windingtemperature", "winding_temperature"},
                             {"motortemperature", "winding_temperature"},
                             {"motortemp", "winding_temperature"},
                             {"loadtorque", "load_torque"}};
constexpr Usual kOfRobot[] = {
    {"commandvx", "command_vx"}, {"cmdvx", "command_vx"}, {"vxcmd", "command_vx"},
    {"commandvy", "command_vy"}, {"cmdvy", "command_vy"}, {"vycmd", "command_vy"},
    {"commandw", "command_w"},   {"cmdw", "command_w"},   {"wcmd", "command_w"},
    {"gyroz", "gyro_z"},         {"accelx", "accel_x"},   {"accely", "accel_y"},
    {"visionx", "vision_x"},     {"visiony", "vision_y"}, {"visiontheta", "vision_theta"},
    {"dribbler", "dribbler"}};
// Behind these stands the wheel's number.
constexpr Usual kOfWheel[] = {{"duty", "duty_"},
                              {"pwm", "duty_"},
                              {"encoder", "encoder_"},
                              {"enc", "encoder_"},
                              {"ticks", "encoder_"},
                              {"counts", "encoder_"},
                              {"current", "motor_current_"},
                              {"motorcurrent", "motor_current_"},
                              {"commandwheel", "command_wheel_"},
                              {"wheelcmd", "command_wheel_"}};

std::string_view look_up(std::span<const Usual> table, std::string_view name) {
  const auto it = std::find_if(table.begin(), table.end(), [&](const Usual& u) { return u.name == name; });
  return it == table.end() ? std::string_view{} : it->signal;
}

// Names that more than one signal goes by.
struct Ambiguous {
  std::string_view name, signals;  // of an axis, with a comma between them
};
constexpr Ambiguous kAmbiguous[] = {{"voltage", "motor_voltage,bus_voltage"},
                                    {"volts", "motor_voltage,bus_voltage"},
                                    {"u", "duty,motor_voltage"},
                                    {"torque", "motor_torque,load_torque"},
                                    {"force", "motor_torque,load_torque"}};

std::string plain(std::string_view name) {
  std::string out;
  for (const char c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0)
      out += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return out;
}

// Of a topic the last word counts: "/drive/velocity", "encoder.angle"; without the place in a list, and without the
// "data" of std_msgs.
std::string_view last_word(std::string_view name) {
  const std::size_t bracket = name.rfind('[');
  if (bracket != std::string_view::npos && bracket > 0 && name.back() == ']') name = name.substr(0, bracket);
  if (name.ends_with(".data")) name.remove_suffix(5);
  const std::size_t cut = name.find_last_of("./:");
  return cut != std::string_view::npos && cut + 1 < name.size() ? name.substr(cut + 1) : name;
}

// "battery_status.voltage_v", "/power/battery/voltage": what the supply says of itself.
bool of_supply(std::string_view name) {
  const std::string_view last = last_word(name);
  const std::string path = plain(name.substr(0, static_cast<std::size_t>(last.data() - name.data())));
  return path.find("battery") != std::string::npos || path.find("supply") != std::string::npos;
}

}  // namespace

const KnownName* known_name(LogFormat format, std::string_view column) {
  const std::span<const KnownName> names = names_of(format);
  const auto find = [&](std::string_view name) -> const KnownName* {
    const auto it =
        std::find_if(names.begin(), names.end(), [&](const KnownName& k) { return k.column == name; });
    return it == names.end() ? nullptr : &*it;
  };
  if (const KnownName* whole = find(column)) return whole;
  // "axis0.motor.foc.Iq_measured": by its last word, or its last two.
  for (std::size_t dot = column.find('.'); dot != std::string_view::npos; dot = column.find('.', dot + 1)) {
    if (const KnownName* part = find(column.substr(dot + 1))) return part;
  }
  return nullptr;
}

std::vector<std::string> ambiguous_signals(std::string_view name, const Rig& rig) {
  std::vector<std::string> out;
  if (rig.of_robot || of_supply(name)) return out;
  const std::string word = plain(last_word(name));
  for (const Ambiguous& a : kAmbiguous) {
    if (a.name != word) continue;
    const std::size_t comma = a.signals.find(',');
    out = {std::string(a.signals.substr(0, comma)), std::string(a.signals.substr(comma + 1))};
  }
  return out;
}

std::string usual_signal(std::string_view name, const Rig& rig) {
  const std::string word = plain(last_word(name));
  if (of_supply(name))
    return word == "voltage" || word == "volts" || word.starts_with("voltage") ? "bus_voltage" : "";
  if (const std::string_view any = look_up(kAnyRig, word); !any.empty()) return std::string(any);
  if (!rig.of_robot) return std::string(look_up(kOfAxis, word));
  if (const std::string_view whole = look_up(kOfRobot, word); !whole.empty()) return std::string(whole);
  if (word.empty() || word.back() < '1' || word.back() > '4') return "";
  const std::string_view wheel = look_up(kOfWheel, std::string_view(word).substr(0, word.size() - 1));
  return wheel.empty() ? "" : std::string(wheel) + word.back();
}

}  // namespace omnihil
