#include "hil/loop/timed_faults_json.h"

#include <nlohmann/json.hpp>
#include <span>

namespace omnihil {
namespace {

using Json = nlohmann::ordered_json;

struct NumberKey {
  const char* name;
  double RobotFaults::*place;
};
constexpr NumberKey kNumbers[] = {{"force_forward_N", &RobotFaults::force_forward_N},
                                  {"force_left_N", &RobotFaults::force_left_N},
                                  {"moment_Nm", &RobotFaults::moment_Nm},
                                  {"supply_ratio", &RobotFaults::supply_ratio}};
struct WheelKey {
  const char* name;
  PerWheel<bool> RobotFaults::*place;
};
constexpr WheelKey kWheelSets[] = {{"lifted", &RobotFaults::lifted},
                                   {"blocked", &RobotFaults::blocked},
                                   {"encoder_stuck", &RobotFaults::encoder_stuck},
                                   {"phase_lost", &RobotFaults::phase_lost}};
constexpr const char* kHeat = "winding_rise_K";

// A bench's robots have four wheels.
template <class T>
std::array<T, kWheels> four(const PerWheel<T>& all) {
  std::array<T, kWheels> out;
  std::copy_n(all.begin(), kWheels, out.begin());
  return out;
}

template <class T>
bool take_four(const Json& value, PerWheel<T>& out, bool (Json::*is_kind)() const noexcept) {
  if (!value.is_array() || value.size() != kWheels) return false;
  for (std::size_t w = 0; w < kWheels; ++w) {
    if (!(value[w].*is_kind)()) return false;
    out[w] = value[w].get<T>();
  }
  return true;
}

bool take(const std::string& name, const Json& value, TimedFault& fault) {
  const bool natural = value.is_number_unsigned() && value.get<std::uint64_t>() <= 1'000'000'000'000'000'000;
  if (name == "robot" && natural && value.get<std::uint64_t>() < 256)
    return fault.key = value.get<int>(), true;
  if (name == "from_ns" && natural) return fault.from_ns = value.get<std::int64_t>(), true;
  if (name == "until_ns" && natural) return fault.until_ns = value.get<std::int64_t>(), true;
  if (name == "silent" && value.is_boolean()) return fault.silent = value.get<bool>(), true;
  for (const NumberKey& key : kNumbers)
    if (name == key.name && value.is_number()) return fault.faults.*(key.place) = value.get<double>(), true;
  for (const WheelKey& key : kWheelSets)
    if (name == key.name) return take_four(value, fault.faults.*(key.place), &Json::is_boolean);
  return name == kHeat && take_four(value, fault.faults.winding_rise_K, &Json::is_number);
}

}  // namespace

Json faults_json(const std::vector<TimedFault>& faults) {
  const RobotFaults healthy;
  Json list = Json::array();
  for (const TimedFault& fault : faults) {
    Json json = Json::object();
    json["robot"] = static_cast<std::uint64_t>(fault.key);
    json["from_ns"] = static_cast<std::uint64_t>(fault.from_ns);
    if (fault.until_ns != TimedFault{}.until_ns)
      json["until_ns"] = static_cast<std::uint64_t>(fault.until_ns);
    if (fault.silent) json["silent"] = true;
    for (const NumberKey& key : kNumbers)
      if (fault.faults.*(key.place) != healthy.*(key.place)) json[key.name] = fault.faults.*(key.place);
    for (const WheelKey& key : kWheelSets)
      if (fault.faults.*(key.place) != healthy.*(key.place)) json[key.name] = four(fault.faults.*(key.place));
    if (fault.faults.winding_rise_K != healthy.winding_rise_K)
      json[kHeat] = four(fault.faults.winding_rise_K);
    list.push_back(std::move(json));
  }
  return list;
}

std::string read_faults(const Json& json, std::vector<TimedFault>& faults) {
  if (!json.is_array()) return "a list of faults";
  for (const Json& item : json) {
    if (!item.is_object() || !item.contains("robot") || !item.contains("from_ns"))
      return "faults with robot and from_ns";
    TimedFault& fault = faults.emplace_back();
    for (const auto& [name, value] : item.items())
      if (!take(name, value, fault))
        return "a fault's robot, from_ns, until_ns, silent, and what scenarios name";
  }
  return {};
}

}  // namespace omnihil
