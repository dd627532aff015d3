// Messages of ROS 2: their definitions as text, their bytes as CDR, taken apart into numbers with names.
//
//   RosType type("sensor_msgs/msg/JointState", definition_text);
//   RosNumbers numbers;
//   if (type.read(bytes, numbers)) numbers.values[0];            // {"position[wheel]", "rad", 1.2}
//
// Sources: ROS 2 interface definitions (design.ros2.org: fields, arrays, bounded and unbounded sequences, constants,
// defaults); DDS-XTypes 7.4.1 (XCDR1: each number stands at a multiple of its size behind the four bytes of the head,
// at most 8; XCDR2: at most 4). Little-endian alone. Elements of lists are named by the strings of a field `name` of
// the same length, as joint states have it, else by their place. Units: those of sensor_msgs and geometry_msgs (REP
// 103). Cannot: wstring, XCDR2 with headers of members, lists beyond kMostElements (left out).
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace omnihil {

inline constexpr std::size_t kMostElements = 64;  // a choice: joints, not pictures

struct RosNumber {
  std::string name;
  std::string unit;  // "" : not known
  double value = 0.0;
};
struct RosNumbers {
  std::vector<RosNumber> values;
  std::int64_t stamp_ns = -1;  // of a header; -1: none
};

class RosType {
 public:
  // `definition`: of the type itself, then of others after lines of "=" and "MSG: package/Type".
  RosType(std::string_view type, std::string_view definition);

  // False: bytes that do not fit the definition, another encoding, or a type that is not defined.
  bool read(std::string_view bytes, RosNumbers& out) const;

  struct Field {
    std::string type, name;
    bool is_list = false;
    std::size_t count = 0;  // of an array; 0 with is_list: a sequence
  };

 private:
  std::string type_;
  std::map<std::string, std::vector<Field>, std::less<>> types_;  // "sensor_msgs/JointState" -> fields
};

// The definition of a type that every ROS 2 has, for bags that carry none; "": not among those known here.
std::string_view common_ros_definition(std::string_view type);

}  // namespace omnihil
