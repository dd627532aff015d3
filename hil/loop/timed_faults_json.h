// Timed faults as a recording's header has them: a list of objects, numbers that are neutral left out.
//
//   std::vector<TimedFault> plan{{.key = 3, .from_ns = 1'000'000'000, .faults = {.supply_ratio = 0.6}}};
//   const auto json = faults_json(plan);        // [{"robot":3,"from_ns":1000000000,"supply_ratio":0.6}]
//   const std::string wrong = read_faults(json, plan);    // "": understood
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "hil/loop/timed_faults.h"

namespace omnihil {

nlohmann::ordered_json faults_json(const std::vector<TimedFault>& faults);
std::string read_faults(const nlohmann::ordered_json& json, std::vector<TimedFault>& faults);

}  // namespace omnihil
