#include "hil/recording/recording_header.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <set>

#include "hil/loop/timed_faults_json.h"
#include "hil/text/json_text.h"
#include "hil/text/recording_text.h"

namespace omnihil {
namespace {

using Json = nlohmann::ordered_json;

template <class Enum>
struct Name {
  Enum value;
  std::string_view name;
};
constexpr std::array<Name<Physics>, 3> kPhysics{
    {{Physics::kSimbody, "simbody"}, {Physics::kSimbodyFree, "simbody-free"}, {Physics::kPlanar, "planar"}}};
constexpr std::array<Name<Integrator>, 2> kIntegrators{
    {{Integrator::kSemiImplicitEuler, "euler"}, {Integrator::kRungeKutta4, "rk4"}}};
constexpr std::array<Name<Team>, 2> kTeams{{{Team::kYellow, "yellow"}, {Team::kBlue, "blue"}}};

struct AirKey {
  std::string_view name;
  double AirOptions::*place;
};
constexpr std::array<AirKey, 14> kAir{{{"share", &AirOptions::share},
                                       {"x_m", &AirOptions::x_m},
                                       {"y_m", &AirOptions::y_m},
                                       {"burst_good_packets", &AirOptions::burst_good_packets},
                                       {"burst_bad_packets", &AirOptions::burst_bad_packets},
                                       {"burst_share", &AirOptions::burst_share},
                                       {"others_load", &AirOptions::others_load},
                                       {"latency_least_s", &AirOptions::latency_least_s},
                                       {"latency_mean_s", &AirOptions::latency_mean_s},
                                       {"latency_sigma", &AirOptions::latency_sigma},
                                       {"twice_share", &AirOptions::twice_share},
                                       {"held_share", &AirOptions::held_share},
                                       {"held_s", &AirOptions::held_s},
                                       {"bit_error_rate", &AirOptions::bit_error_rate}}};
constexpr std::array<Name<LatencyLaw>, 3> kLatencyLaws{{{LatencyLaw::kExponential, "exponential"},
                                                        {LatencyLaw::kUniform, "uniform"},
                                                        {LatencyLaw::kLognormal, "lognormal"}}};

struct CarpetKey {
  std::string_view name;
  double Carpet::*place;
};
constexpr std::array<CarpetKey, 6> kCarpet{{{"sliding", &Carpet::sliding_friction},
                                            {"rolling", &Carpet::rolling_resistance},
                                            {"spinning", &Carpet::spinning_friction},
                                            {"restitution", &Carpet::restitution},
                                            {"nap", &Carpet::nap_ratio},
                                            {"nap_rad", &Carpet::nap_rad}}};

Json carpet_json(const Carpet& carpet) {
  const Carpet usual;
  Json json = Json::object();
  for (const CarpetKey& key : kCarpet)
    if (carpet.*(key.place) != usual.*(key.place)) json[std::string(key.name)] = carpet.*(key.place);
  for (const CarpetPatch& p : carpet.patches)
    json["patches"].push_back({p.x_from_m, p.x_to_m, p.y_from_m, p.y_to_m, p.sliding_ratio, p.rolling_ratio});
  return json;
}

Json models_json(const std::vector<ModelText>& models) {
  Json json = Json::object();
  for (const ModelText& model : models) json[model.name] = model.text;
  return json;
}

template <class Table, class Enum>
std::string_view name_of(const Table& table, Enum value) {
  for (const auto& row : table) {
    if (row.value == value) return row.name;
  }
  return "";
}

// Takes the keys of the header one by one and keeps what is wrong with them.
constexpr double kMostSpread = 10.0;

class HeaderFields {
 public:
  HeaderFields(const Json& json, std::vector<std::string>& problems) : json_(json), problems_(problems) {}

  void text(const char* key, std::string& value) {
    if (const Json* found = find(key, "a text", &Json::is_string)) value = found->get<std::string>();
  }
  void natural(const char* key, std::uint64_t& value) {
    if (const Json* found = find(key, "a whole number >= 0", &Json::is_number_unsigned)) {
      value = found->get<std::uint64_t>();
    }
  }
  void positive(const char* key, std::int64_t& value) {
    const Json* found = find(key, "a whole number > 0", &Json::is_number_unsigned);
    if (found == nullptr) return;
    constexpr std::uint64_t kDay_ns = 86'400'000'000'000;
    const std::uint64_t number = found->get<std::uint64_t>();
    if (number == 0 || number > kDay_ns) {
      refuse(key, found->dump(), "a whole number from 1 to 86400000000000");
    } else {
      value = static_cast<std::int64_t>(number);
    }
  }
  template <class Table, class Enum>
  void one_of(const char* key, const Table& table, Enum& value) {
    const Json* found = find(key, "a text", &Json::is_string);
    if (found == nullptr) return;
    std::string allowed;
    for (const auto& row : table) {
      if (row.name == found->get_ref<const std::string&>()) {
        value = row.value;
        return;
      }
      allowed += (allowed.empty() ? "" : ", ") + std::string(row.name);
    }
    refuse(key, found->dump(), allowed);
  }
  void texts(const char* key, std::vector<std::string>& values) {
    const Json* found = find(key, "a list of texts", &Json::is_array);
    if (found == nullptr) return;
    for (const Json& item : *found) {
      if (!item.is_string()) return refuse(key, item.dump(), "a list of texts");
      values.push_back(item.get<std::string>());
    }
  }
  void ids(const char* key, std::vector<int>& values) {
    const Json* found = find(key, "a list of robot ids", &Json::is_array);
    if (found == nullptr) return;
    for (const Json& item : *found) {
      if (!item.is_number_unsigned() || item.get<std::uint64_t>() > 255 ||
          (!values.empty() && item.get<int>() <= values.back())) {
        return refuse(key, item.dump(), "ascending whole numbers from 0 to 255");
      }
      values.push_back(item.get<int>());
    }
    if (values.empty()) refuse(key, "[]", "at least one robot id");
  }
  void models(const char* key, std::vector<ModelText>& values) {
    const Json* found = find(key, "an object of texts", &Json::is_object);
    if (found == nullptr) return;
    for (const auto& [name, text] : found->items()) {
      if (!text.is_string()) return refuse(key, text.dump(), "an object of texts");
      values.push_back({name, text.get<std::string>()});
    }
  }
  // Absent: none.
  void hashes(const char* key, std::vector<HashedFile>& values) {
    if (!json_.contains(key)) return;
    std::vector<ModelText> texts;
    models(key, texts);
    for (ModelText& each : texts) values.push_back({std::move(each.name), std::move(each.text)});
  }
  // Absent: nothing is lost. Within it every key may be absent, which is 0, no, and exponential.
  void air(const char* key, AirOptions& options) {
    if (!json_.contains(key)) return;
    const Json* found = find(key, "an object of numbers", &Json::is_object);
    if (found == nullptr) return;
    for (const auto& [name, value] : found->items()) {
      if (name == "latency_law" && value.is_string()) {
        HeaderFields(*found, problems_).one_of("latency_law", kLatencyLaws, options.latency_law);
        continue;
      }
      if (name == "in_order" && value.is_boolean()) {
        options.in_order = value.get<bool>();
        continue;
      }
      const auto row = std::ranges::find(kAir, name, &AirKey::name);
      if (row == kAir.end() || !value.is_number())
        return refuse(key, found->dump(), "an object of the air's numbers");
      options.*(row->place) = value.get<double>();
    }
    options.by_distance = found->contains("x_m");
    for (const std::string& problem : air_problems(options)) refuse(key, found->dump(), problem);
  }
  // Absent: robots alone on an endless floor, which do not touch.
  void field(const char* key, FieldSetup& setup) {
    if (!json_.contains(key)) return;
    const Json* found = find(key, "an object", &Json::is_object);
    if (found == nullptr) return;
    setup.contacts = true;
    for (const auto& [name, value] : found->items()) {
      if (name == "size" && value.is_string()) {
        setup.size = find_field(value.get<std::string>());
        if (setup.size == nullptr) refuse(key, value.dump(), "a field such as division-b");
      } else if (name == "ball" && value.is_array() && value.size() == 2 && value[0].is_number() &&
                 value[1].is_number()) {
        setup.ball_m = {value[0].get<double>(), value[1].get<double>()};
      } else if (name == "carpet" && value.is_object()) {
        carpet(key, value, setup.carpet);
      } else if (name == "ball_lift" && value.is_number()) {
        setup.ball_lift_coefficient = value.get<double>();
      } else {
        return refuse(key, found->dump(),
                      "an object of size, ball, carpet, ball_lift, each as this program writes it");
      }
    }
  }
  // Absent: the usual one. Within it every key may be absent.
  void carpet(const char* key, const Json& found, Carpet& carpet) {
    for (const auto& [name, value] : found.items()) {
      const auto row = std::ranges::find(kCarpet, name, &CarpetKey::name);
      if (row != kCarpet.end() && value.is_number()) {
        carpet.*(row->place) = value.get<double>();
      } else if (name == "patches" && value.is_array()) {
        for (const Json& p : value) {
          const bool numbers = p.is_array() && p.size() == 6 &&
                               std::ranges::all_of(p, [](const Json& x) { return x.is_number(); });
          if (!numbers) return refuse(key, p.dump(), "six numbers of a patch");
          carpet.patches.push_back({p[0], p[1], p[2], p[3], p[4], p[5]});
        }
      } else {
        return refuse(key, found.dump(), "an object of the carpet's numbers");
      }
    }
    for (const std::string& problem : carpet_problems(carpet)) refuse(key, found.dump(), problem);
  }
  // Absent: every robot is of the session's model.
  void others(const char* key, std::vector<OtherRobots>& others) {
    if (!json_.contains(key)) return;
    const Json* found = find(key, "a list", &Json::is_array);
    if (found == nullptr) return;
    for (const Json& item : *found) {
      if (!item.is_object()) return refuse(key, item.dump(), "a list of objects");
      HeaderFields fields(item, problems_);
      OtherRobots& other = others.emplace_back();
      fields.ids("robot_ids", other.keys);
      fields.text("robot", other.robot_model);
      fields.text("robot_text", other.robot_model_text);
      fields.models("included_models", other.included_models);
      fields.nothing_else();
    }
  }
  // Absent: robots in a row, at rest.
  void bytes(const char* key, std::vector<std::uint8_t>& value) {
    if (!json_.contains(key)) return;
    std::string digits;
    text(key, digits);
    if (digits.empty() || !parse_hex(digits, value)) refuse(key, digits.substr(0, 16), "pairs of hex digits");
  }
  // Absent: none. Which robots there are is the session's to check.
  void faults(const char* key, std::vector<TimedFault>& value) {
    if (!json_.contains(key)) return;
    const Json* found = find(key, "a list", &Json::is_array);
    if (found == nullptr) return;
    if (const std::string allowed = read_faults(*found, value); !allowed.empty())
      refuse(key, found->dump(), allowed);
  }
  void text_or_none(const char* key, std::string& value) {
    if (json_.contains(key)) text(key, value);
  }
  // Absent: every robot is the model itself.
  void spread(const char* key, double& value) {
    if (!json_.contains(key)) return;
    const Json* found = find(key, "a number", &Json::is_number);
    if (found == nullptr) return;
    value = found->get<double>();
    if (!(value >= 0.0 && value <= kMostSpread)) refuse(key, found->dump(), "0 to 10");
  }
  // Absent: none.
  void opponents(const char* key, RecordingHeader& header) {
    if (!json_.contains(key)) return;
    const Json* found = find(key, "an object", &Json::is_object);
    if (found == nullptr) return;
    HeaderFields fields(*found, problems_);
    fields.ids("robot_ids", header.opponent_ids);
    if (found->contains("radio")) fields.text("radio", header.opponents_radio);
    fields.nothing_else();
  }
  void nothing_else() {
    for (const auto& [key, value] : json_.items()) {
      if (!known_.contains(key)) refuse(key.c_str(), value.dump(), "no such key");
    }
  }
  void refuse(const char* key, const std::string& found, std::string_view allowed) {
    problems_.push_back("key '" + std::string(key) + "': found " + in_quotes(found) +
                        ", allowed: " + std::string(allowed));
  }

 private:
  const Json* find(const char* key, std::string_view allowed, bool (Json::*is_kind)() const noexcept) {
    known_.insert(key);
    const auto at = json_.find(key);
    if (at == json_.end()) {
      refuse(key, "nothing", allowed);
      return nullptr;
    }
    if (!((*at).*is_kind)()) {
      refuse(key, at->dump(), allowed);
      return nullptr;
    }
    return &*at;
  }

  const Json& json_;
  std::vector<std::string>& problems_;
  std::set<std::string> known_;
};

void read_fields(HeaderFields& fields, RecordingHeader& header) {
  std::uint64_t sample_every = 1;
  std::string format;
  fields.text("format", format);
  if (!format.empty() && format != kRecordingFormat) fields.refuse("format", format, kRecordingFormat);
  fields.text("commit", header.commit);
  fields.text("started", header.started);
  fields.text("robot", header.robot_model);
  fields.text("robot_text", header.robot_model_text);
  fields.models("included_models", header.included_models);
  fields.text("radio", header.radio_format);
  fields.text("firmware", header.firmware);
  fields.hashes("firmware_files", header.firmware_files);
  fields.ids("robot_ids", header.robot_ids);
  fields.one_of("team", kTeams, header.team);
  fields.one_of("physics", kPhysics, header.plant.physics);
  fields.one_of("integrator", kIntegrators, header.plant.integrator);
  fields.positive("mechanical_step_ns", header.plant.mechanical_step_ns);
  fields.positive("electrical_step_ns", header.plant.electrical_step_ns);
  fields.positive("step_ns", header.step_ns);
  fields.natural("epoch_ms", header.epoch_ms);
  fields.natural("seed", header.seed);
  fields.air("air", header.air);
  fields.field("field", header.field);
  fields.opponents("opponents", header);
  fields.faults("faults", header.faults);
  fields.text_or_none("bench", header.bench);
  fields.spread("spread", header.spread);
  fields.others("other_robots", header.other_robots);
  fields.bytes("from", header.from);
  fields.natural("sample_every", sample_every);
  if (sample_every < 1 || sample_every > 1'000'000) {
    fields.refuse("sample_every", std::to_string(sample_every), "1 to 1000000");
  }
  fields.texts("columns", header.columns);
  fields.texts("units", header.units);
  fields.nothing_else();
  if (header.columns.size() != header.units.size()) {
    fields.refuse("units", std::to_string(header.units.size()) + " units",
                  "as many as columns: " + std::to_string(header.columns.size()));
  }
  if (std::set<std::string>(header.columns.begin(), header.columns.end()).size() != header.columns.size()) {
    fields.refuse("columns", "a name twice", "each name once");
  }
  header.sample_every = static_cast<int>(sample_every);
  header.plant.seed = header.seed;
}

}  // namespace

std::string_view to_string(Physics physics) { return name_of(kPhysics, physics); }
std::string_view to_string(Integrator integrator) { return name_of(kIntegrators, integrator); }

std::optional<Physics> parse_physics(std::string_view name) {
  for (const auto& row : kPhysics) {
    if (row.name == name) return row.value;
  }
  return std::nullopt;
}

std::vector<int> robot_keys(const RecordingHeader& header) {
  std::vector<int> keys = header.robot_ids;
  for (const int id : header.opponent_ids) keys.push_back(kOpponentKey + id);
  return keys;
}

std::string to_json(const RecordingHeader& header) {
  Json json;
  json["format"] = kRecordingFormat;
  json["commit"] = header.commit;
  json["started"] = header.started;
  json["robot"] = header.robot_model;
  json["robot_text"] = header.robot_model_text;
  json["included_models"] = models_json(header.included_models);
  json["radio"] = header.radio_format;
  json["firmware"] = header.firmware;
  for (const HashedFile& file : header.firmware_files) json["firmware_files"][file.name] = file.sha256;
  json["robot_ids"] = header.robot_ids;
  json["team"] = name_of(kTeams, header.team);
  json["physics"] = to_string(header.plant.physics);
  json["integrator"] = to_string(header.plant.integrator);
  json["mechanical_step_ns"] = static_cast<std::uint64_t>(header.plant.mechanical_step_ns);
  json["electrical_step_ns"] = static_cast<std::uint64_t>(header.plant.electrical_step_ns);
  json["step_ns"] = static_cast<std::uint64_t>(header.step_ns);
  json["epoch_ms"] = header.epoch_ms;
  json["seed"] = header.seed;
  if (header.air.any()) {
    Json air = Json::object();
    for (const AirKey& key : kAir) {
      const bool of_place = key.place == &AirOptions::x_m || key.place == &AirOptions::y_m;
      const bool told = of_place ? header.air.by_distance : header.air.*(key.place) != 0.0;
      if (told) air[std::string(key.name)] = header.air.*(key.place);
    }
    if (header.air.latency_law != LatencyLaw::kExponential)
      air["latency_law"] = name_of(kLatencyLaws, header.air.latency_law);
    if (header.air.in_order) air["in_order"] = true;
    json["air"] = std::move(air);
  }
  if (!header.faults.empty()) json["faults"] = faults_json(header.faults);
  if (!header.bench.empty()) json["bench"] = header.bench;
  if (header.field.contacts) {
    Json field = Json::object();
    if (header.field.size != nullptr) field["size"] = header.field.size->name;
    if (header.field.ball_m) field["ball"] = *header.field.ball_m;
    if (Json carpet = carpet_json(header.field.carpet); !carpet.empty()) field["carpet"] = std::move(carpet);
    if (header.field.ball_lift_coefficient != 0.0) field["ball_lift"] = header.field.ball_lift_coefficient;
    json["field"] = std::move(field);
  }
  if (!header.opponent_ids.empty()) {
    json["opponents"]["robot_ids"] = header.opponent_ids;
    if (!header.opponents_radio.empty()) json["opponents"]["radio"] = header.opponents_radio;
  }
  if (header.spread > 0.0) json["spread"] = header.spread;
  for (const OtherRobots& other : header.other_robots)
    json["other_robots"].push_back({{"robot_ids", other.keys},
                                    {"robot", other.robot_model},
                                    {"robot_text", other.robot_model_text},
                                    {"included_models", models_json(other.included_models)}});
  if (!header.from.empty()) json["from"] = to_hex(header.from);
  json["sample_every"] = header.sample_every;
  json["columns"] = header.columns;
  json["units"] = header.units;
  return json_text(json);
}

std::optional<RecordingHeader> parse_recording_header(std::string_view text,
                                                      std::vector<std::string>& problems) {
  const Json json = json_of(text);
  if (!json.is_object()) {
    problems.push_back("found " + in_quotes(text) + ", allowed: the header as one JSON object");
    return std::nullopt;
  }
  const std::size_t before = problems.size();
  RecordingHeader header;
  HeaderFields fields(json, problems);
  read_fields(fields, header);
  if (problems.size() != before) return std::nullopt;
  return header;
}

}  // namespace omnihil
