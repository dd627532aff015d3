#include "hil/logs/bag_topics.h"

#include <fmt/format.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "hil/text/json_text.h"

namespace omnihil {
namespace {

void flatten(const nlohmann::ordered_json& json, const std::string& name, RosNumbers& out) {
  if (json.is_number() || json.is_boolean()) {
    out.values.push_back({name, "", json.is_boolean() ? (json.get<bool>() ? 1.0 : 0.0) : json.get<double>()});
  } else if (json.is_object()) {
    for (const auto& [key, value] : json.items()) flatten(value, name.empty() ? key : name + "." + key, out);
  } else if (json.is_array() && json.size() <= kMostElements) {
    for (std::size_t i = 0; i < json.size(); ++i) flatten(json[i], fmt::format("{}[{}]", name, i), out);
  }
}

}  // namespace

void BagTopics::define(std::uint64_t id, const std::string& topic, const std::string& encoding,
                       const std::string& type, std::string_view definition) {
  Topic& t = topics_[id];
  t.name = topic;
  t.type = type;
  if (encoding == "json") {
    t.json = true;
  } else if (encoding != "cdr") {
    t.why_not = fmt::format("encoding {}", encoding);
  } else {
    if (definition.empty()) definition = common_ros_definition(type);
    if (definition.empty()) {
      t.why_not = fmt::format("type {} has no definition in the bag", type);
    } else {
      t.ros.emplace(type, definition);
    }
  }
}

void BagTopics::add(std::uint64_t id, std::int64_t log_time_ns, std::string_view bytes) {
  const auto found = topics_.find(id);
  if (found == topics_.end()) {
    ++unknown_;
    return;
  }
  Topic& t = found->second;
  RosNumbers numbers;
  bool good = false;
  if (t.json) {
    const nlohmann::ordered_json json = json_of(bytes);
    good = !json.is_discarded();
    if (good) flatten(json, "", numbers);
  } else if (t.ros) {
    good = t.ros->read(bytes, numbers);
    if (!good) t.why_not = fmt::format("bytes that do not fit {}", t.type);
  }
  if (!good) {
    ++t.left_out;
    return;
  }
  std::int64_t at = log_time_ns;
  if (numbers.stamp_ns > 0 && log_time_ns >= 0 && std::abs(numbers.stamp_ns - log_time_ns) < kMostApart_ns) {
    at = numbers.stamp_ns;
    ++t.stamped;
  }
  for (const RosNumber& n : numbers.values)
    series_.add(n.name.empty() ? t.name : t.name + "." + n.name, at, n.value, n.unit);
}

LogTable BagTopics::table(LogFormat format) const {
  LogTable log = series_.table(format);
  for (const auto& [id, t] : topics_) {
    if (t.left_out > 0)
      log.notes.push_back(fmt::format("{}: {}: {} messages left out: {}", path_, t.name, t.left_out,
                                      t.why_not.empty() ? "no JSON" : t.why_not));
    if (t.stamped > 0)
      log.notes.push_back(
          fmt::format("{}: {}: {} messages stand at the stamp of their header", path_, t.name, t.stamped));
  }
  if (unknown_ > 0)
    log.notes.push_back(fmt::format("{}: {} messages of no known topic left out", path_, unknown_));
  if (log.series.empty()) {
    std::string why;
    for (const std::string& note : log.notes) why += "; " + note;
    throw BadLog(fmt::format(
        "{}: has no numbers that can be read{}; allowed: messages in CDR with their definitions, or in JSON",
        path_, why));
  }
  return log;
}

}  // namespace omnihil
