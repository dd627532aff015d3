// JSON as text and back: the one place that makes nlohmann's writer and reader, each 2 s of compilation.
//
//   std::string line = json_text(json);           // no line ends; bytes that are no UTF-8 become U+FFFD
//   std::string page = json_text(json, 2);        // indented by two
//
// Text that is no JSON gives a value that is_discarded(), not an exception.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace omnihil {

std::string json_text(const nlohmann::ordered_json& json, int indent = -1);
nlohmann::ordered_json json_of(std::string_view text);

}  // namespace omnihil
