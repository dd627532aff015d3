#include "hil/logs/ros_message.h"

#include <fmt/format.h>

#include <charconv>
#include <cstring>
#include <optional>

namespace omnihil {
namespace {

constexpr int kMostDepth = 10;

// "sensor_msgs/msg/JointState" -> "sensor_msgs/JointState"
std::string short_name(std::string_view type) {
  const std::size_t at = type.find("/msg/");
  return at == std::string_view::npos ? std::string(type)
                                      : std::string(type.substr(0, at)) + std::string(type.substr(at + 4));
}

std::size_t size_of_primitive(std::string_view type) {
  if (type == "bool" || type == "byte" || type == "char" || type == "int8" || type == "uint8") return 1;
  if (type == "int16" || type == "uint16") return 2;
  if (type == "int32" || type == "uint32" || type == "float32") return 4;
  if (type == "int64" || type == "uint64" || type == "float64") return 8;
  return 0;
}

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> out;
  std::size_t at = 0;
  while ((at = line.find_first_not_of(" \t\r", at)) != std::string_view::npos) {
    const std::size_t end = std::min(line.find_first_of(" \t\r", at), line.size());
    out.push_back(line.substr(at, end - at));
    at = end;
  }
  return out;
}

// "float64[3] phases", "string<=10 who", "std_msgs/Header header", "uint8 MODE=1"; none: no field.
std::optional<RosType::Field> field_of_line(std::string_view line, const std::string& package) {
  line = line.substr(0, line.find('#'));
  const std::vector<std::string_view> words = words_of(line);
  if (words.size() < 2 || words[1].find('=') != std::string_view::npos ||
      (words.size() > 2 && words[2].starts_with("=")))
    return std::nullopt;
  RosType::Field out;
  out.name = words[1];
  std::string_view type = words[0];
  if (const std::size_t bracket = type.find('['); bracket != std::string_view::npos) {
    out.is_list = true;
    const std::string_view inside = type.substr(bracket + 1, type.find(']') - bracket - 1);
    if (!inside.empty() && inside[0] != '<')
      std::from_chars(inside.data(), inside.data() + inside.size(), out.count);
    type = type.substr(0, bracket);
  }
  type = type.substr(0, type.find('<'));  // a bounded string
  out.type = type;
  if (size_of_primitive(type) == 0 && type != "string" && type != "wstring") {
    out.type = type == "Header"                           ? "std_msgs/Header"
               : type.find('/') == std::string_view::npos ? package + "/" + out.type
                                                          : short_name(type);
  }
  return out;
}

// Units of the fields of messages that every ROS 2 has (REP 103); by the type and the field.
std::string_view unit_of_field(std::string_view type, std::string_view field) {
  struct Row {
    std::string_view type, field, unit;
  };
  static constexpr Row kRows[] = {
      {"sensor_msgs/JointState", "position", "rad"}, {"sensor_msgs/JointState", "velocity", "rad/s"},
      {"sensor_msgs/JointState", "effort", "N m"},   {"sensor_msgs/BatteryState", "voltage", "V"},
      {"sensor_msgs/BatteryState", "current", "A"},  {"sensor_msgs/BatteryState", "temperature", "degC"}};
  for (const Row& row : kRows) {
    if (row.type == type && row.field == field) return row.unit;
  }
  return "";
}

class CdrReader {
 public:
  CdrReader(std::string_view body, std::size_t most_alignment) : body_(body), most_(most_alignment) {}

  bool failed() const { return failed_; }
  bool skip(std::size_t size) {
    if (size > body_.size() - at_) failed_ = true;
    if (!failed_) at_ += size;
    return !failed_;
  }
  void align(std::size_t size) {
    const std::size_t to = std::min(size, most_);
    skip((to - at_ % to) % to);
  }
  template <typename T>
  T number() {
    T value{};
    align(sizeof value);
    const std::size_t from = at_;
    if (skip(sizeof value)) std::memcpy(&value, body_.data() + from, sizeof value);
    return value;
  }
  double primitive(std::string_view type) {
    if (type == "int8") return number<std::int8_t>();
    if (type == "int16") return number<std::int16_t>();
    if (type == "uint16") return number<std::uint16_t>();
    if (type == "int32") return number<std::int32_t>();
    if (type == "uint32") return number<std::uint32_t>();
    if (type == "float32") return number<float>();
    if (type == "float64") return number<double>();
    if (type == "int64") return static_cast<double>(number<std::int64_t>());
    if (type == "uint64") return static_cast<double>(number<std::uint64_t>());
    return number<std::uint8_t>();  // bool, byte, char, uint8
  }
  std::string_view text() {  // a length with the zero at the end, and the letters
    const auto size = number<std::uint32_t>();
    const std::size_t from = at_;
    if (!skip(size)) return {};
    return body_.substr(from, size > 0 ? size - 1 : 0);
  }
  std::size_t left() const { return body_.size() - at_; }

 private:
  std::string_view body_;
  std::size_t most_, at_ = 0;
  bool failed_ = false;
};

using RosTypes = std::map<std::string, std::vector<RosType::Field>, std::less<>>;

class MessageReader {
 public:
  MessageReader(const RosTypes& types, CdrReader& in, RosNumbers& out) : types_(types), in_(in), out_(out) {}

  bool read(const std::string& type, const std::string& prefix, int depth) {
    const auto found = types_.find(type);
    if (found == types_.end() || depth > kMostDepth) return false;
    if (type == "builtin_interfaces/Time" || type == "builtin_interfaces/Duration") {
      const auto seconds = in_.number<std::int32_t>();
      const auto nanoseconds = in_.number<std::uint32_t>();
      if (prefix == "header.stamp.") out_.stamp_ns = seconds * std::int64_t{1'000'000'000} + nanoseconds;
      return !in_.failed();
    }
    std::vector<std::string> names;  // of a list's elements
    for (const RosType::Field& field : found->second) {
      if (!read_field(type, field, prefix, depth, names)) return false;
    }
    return true;
  }

 private:
  bool read_field(const std::string& type, const RosType::Field& field, const std::string& prefix, int depth,
                  std::vector<std::string>& names) {
    const std::size_t size = size_of_primitive(field.type);
    std::size_t count = 1;
    if (field.is_list) count = field.count > 0 ? field.count : in_.number<std::uint32_t>();
    if (in_.failed() || count > in_.left()) return count == 0;  // even of bytes there cannot be so many
    if (size > 0 && count > kMostElements) {
      in_.align(size);
      return in_.skip(size * count);
    }
    if (field.type == "wstring") return false;
    if (field.type == "string") {
      for (std::size_t i = 0; i < count && !in_.failed(); ++i) {
        const std::string_view word = in_.text();
        if (field.is_list && field.name == "name") names.emplace_back(word);
      }
      return !in_.failed();
    }
    for (std::size_t i = 0; i < count; ++i) {
      std::string name = prefix + field.name;
      if (field.is_list)
        name += names.size() == count ? fmt::format("[{}]", names[i]) : fmt::format("[{}]", i);
      if (size == 0) {
        if (!read(field.type, name + ".", depth + 1)) return false;
        continue;
      }
      const double value = in_.primitive(field.type);
      if (in_.failed()) return false;
      out_.values.push_back({std::move(name), std::string(unit_of_field(type, field.name)), value});
    }
    return true;
  }

  const RosTypes& types_;
  CdrReader& in_;
  RosNumbers& out_;
};

}  // namespace

RosType::RosType(std::string_view type, std::string_view definition) : type_(short_name(type)) {
  std::string current = type_;
  types_[current];
  while (!definition.empty()) {
    const std::size_t end = std::min(definition.find('\n'), definition.size());
    std::string_view line = definition.substr(0, end);
    definition.remove_prefix(std::min(end + 1, definition.size()));
    if (line.starts_with("===")) continue;
    if (line.starts_with("MSG:")) {
      const std::vector<std::string_view> words = words_of(line.substr(4));
      current = words.empty() ? "" : short_name(words[0]);
      types_[current];
      continue;
    }
    if (auto field = field_of_line(line, current.substr(0, current.find('/'))))
      types_[current].push_back(std::move(*field));
  }
  types_.try_emplace("builtin_interfaces/Time");
  types_.try_emplace("builtin_interfaces/Duration");
  if (types_.find("std_msgs/Header") == types_.end())
    types_["std_msgs/Header"] = {{"builtin_interfaces/Time", "stamp"}, {"string", "frame_id"}};
}

bool RosType::read(std::string_view bytes, RosNumbers& out) const {
  // Head: 00 01 CDR, 00 07 plain XCDR2, both little-endian; two bytes of options.
  if (bytes.size() < 4 || bytes[0] != 0 || (bytes[1] != 1 && bytes[1] != 7)) return false;
  CdrReader in(bytes.substr(4), bytes[1] == 1 ? 8 : 4);
  return MessageReader(types_, in, out).read(type_, "", 0) && !in.failed();
}

std::string_view common_ros_definition(std::string_view type) {
  struct Row {
    std::string_view type, text;
  };
  // Fields as the packages std_msgs, sensor_msgs, geometry_msgs and nav_msgs of ROS 2 define them.
  static constexpr std::string_view kVector = "float64 x\nfloat64 y\nfloat64 z\n";
  static const std::string kTwist =
      fmt::format("Vector3 linear\nVector3 angular\n===\nMSG: geometry_msgs/Vector3\n{}", kVector);
  static const std::string kTwistStamped =
      fmt::format("std_msgs/Header header\nTwist twist\n===\nMSG: geometry_msgs/Twist\n{}", kTwist);
  static const std::string kImu = fmt::format(
      "std_msgs/Header header\ngeometry_msgs/Quaternion orientation\nfloat64[9] "
      "orientation_covariance\ngeometry_msgs/Vector3 angular_velocity\n"
      "float64[9] angular_velocity_covariance\ngeometry_msgs/Vector3 linear_acceleration\nfloat64[9] "
      "linear_acceleration_covariance\n===\n"
      "MSG: geometry_msgs/Quaternion\n{0}float64 w\n===\nMSG: geometry_msgs/Vector3\n{0}",
      kVector);
  static const std::string kPose = fmt::format(
      "std_msgs/Header header\nPose pose\n===\nMSG: geometry_msgs/Pose\nPoint position\nQuaternion "
      "orientation\n===\nMSG: geometry_msgs/Point\n{0}"
      "===\nMSG: geometry_msgs/Quaternion\n{0}float64 w\n",
      kVector);
  static const Row kRows[] = {
      {"std_msgs/Float64", "float64 data"},
      {"std_msgs/Float32", "float32 data"},
      {"std_msgs/Int64", "int64 data"},
      {"std_msgs/Int32", "int32 data"},
      {"std_msgs/Int16", "int16 data"},
      {"std_msgs/UInt32", "uint32 data"},
      {"std_msgs/UInt16", "uint16 data"},
      {"std_msgs/UInt8", "uint8 data"},
      {"std_msgs/Bool", "bool data"},
      {"sensor_msgs/JointState",
       "std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort"},
      {"sensor_msgs/Imu", kImu},
      {"geometry_msgs/Twist", kTwist},
      {"geometry_msgs/TwistStamped", kTwistStamped},
      {"geometry_msgs/PoseStamped", kPose},
      {"sensor_msgs/Temperature", "std_msgs/Header header\nfloat64 temperature\nfloat64 variance"}};
  const std::string name = short_name(type);
  for (const Row& row : kRows) {
    if (row.type == name) return row.text;
  }
  return "";
}

}  // namespace omnihil
