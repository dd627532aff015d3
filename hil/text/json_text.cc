#include "hil/text/json_text.h"

#include <nlohmann/json.hpp>

namespace omnihil {

using Json = nlohmann::ordered_json;

std::string json_text(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

Json json_of(std::string_view text) { return Json::parse(text, nullptr, false); }

}  // namespace omnihil
