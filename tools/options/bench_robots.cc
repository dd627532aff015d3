#include "tools/options/bench_robots.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "hil/scenario/scenario.h"

namespace omnihil {
namespace {

constexpr std::array<std::string_view, 2> kTeams{"blue", "yellow"};
constexpr double kFarthest_m = 20.0;

// A value as it stands in an inline table.
bool as_text(const toml::node& node, std::string& out) {
  if (const auto* word = node.as_string()) {
    out += '"';
    for (const char c : word->get()) {
      if (static_cast<unsigned char>(c) < 0x20) return false;
      if (c == '"' || c == '\\') out += '\\';
      out += c;
    }
    out += '"';
  } else if (const auto* whole = node.as_integer()) {
    out += std::to_string(whole->get());
  } else if (const auto* number = node.as_floating_point()) {
    const std::string digits = fmt::format("{}", number->get());
    out += digits.find_first_of(".en") == std::string::npos ? digits + ".0" : digits;
  } else if (const auto* flag = node.as_boolean()) {
    out += flag->get() ? "true" : "false";
  } else if (const auto* list = node.as_array()) {
    out += '[';
    for (std::size_t i = 0; i < list->size(); ++i) {
      if (i > 0) out += ", ";
      if (list->get(i)->is_array() || !as_text(*list->get(i), out)) return false;
    }
    out += ']';
  } else {
    return false;
  }
  return true;
}

class Rows {
 public:
  Rows(const ModelDocument& document, const std::function<std::string(const std::string&)>& beside,
       std::vector<ModelProblem>& problems)
      : document_(document), beside_(beside), problems_(problems), keys_(document, problems) {
    if (const auto team = document.table["team"].value<std::string>()) team_ = *team;
  }

  BenchRows read() {
    each("robot", [this](const toml::table& t, const std::string& path) { robot(t, path); });
    each("fault", [this](const toml::table& t, const std::string& path) { fault(t, path); });
    return std::move(out_);
  }

 private:
  template <class Work>
  void each(std::string_view key, Work&& work) {
    const toml::node* node = document_.table.get(key);
    if (node == nullptr || !node->is_array_of_tables())
      return;  // what else it is, the other keys' reader says
    std::size_t n = 0;
    for (const toml::node& entry : *node->as_array())
      work(*entry.as_table(), fmt::format("{}[{}]", key, ++n));
  }

  // Ids as a text: 3 or "0,2-4"; "" where they are missing or wrong.
  std::string ids(const toml::table& t, const std::string& path, std::string_view key) {
    const toml::node* node = t.get(key);
    if (node == nullptr) {
      keys_.missing(t, path, key, "a robot's number, or several as in \"0,2-4\"");
      return {};
    }
    if (const auto whole = node->value_exact<std::int64_t>(); whole && *whole >= 0)
      return std::to_string(*whole);
    const auto word = node->value_exact<std::string>();
    if (word && !word->empty() && word->find_first_not_of("0123456789,-") == std::string::npos) return *word;
    keys_.wrong(*node, key_path(path, key), "names no robots", "allowed: 3, or \"0,2-4\"");
    return {};
  }

  bool is_opponent(const toml::table& t, const std::string& path) {
    const auto team = keys_.word(t, path, "team", kTeams, std::nullopt);
    return t.get("team") != nullptr && team && kTeams[*team] != team_;
  }

  void add(const char* option, const std::string& robots, const std::string& value) {
    out_.arguments.push_back(fmt::format("--{}={}={}", option, robots, value));
  }

  void robot(const toml::table& t, const std::string& path) {
    static constexpr std::string_view kKeys[] = {"id",   "team", "model", "firmware", "board",
                                                 "with", "x_m",  "y_m",   "yaw_deg"};
    keys_.only(t, path, kKeys);
    const std::string id = ids(t, path, "id");
    const bool other = is_opponent(t, path);
    if (!id.empty()) (other ? out_.opponents : out_.own).push_back(id);
    const std::string robots = (other ? "opponents:" : "") + id;
    if (const auto model = keys_.text(t, path, "model")) add("robot-of", robots, beside_(*model));
    firmware(t, path, robots);
    effects(t, path, robots);
    start(t, path, robots);
  }

  void firmware(const toml::table& t, const std::string& path, const std::string& robots) {
    const auto file = keys_.text(t, path, "firmware"), board = keys_.text(t, path, "board");
    if (board && !file) keys_.missing(t, path, "firmware", "the image that the board runs");
    if (file) add("firmware-of", robots, beside_(*file) + (board ? "+" + beside_(*board) : ""));
  }

  void effects(const toml::table& t, const std::string& path, const std::string& robots) {
    const toml::node* node = t.get("with");
    if (node == nullptr) return;
    if (const auto word = node->value_exact<std::string>()) return add("with-of", robots, *word);
    const toml::array* list = node->as_array();
    if (list == nullptr || !list->is_homogeneous<std::string>())
      return keys_.wrong(*node, key_path(path, "with"), "is no effect", "allowed: a text or a list of texts");
    for (const toml::node& item : *list) add("with-of", robots, *item.value<std::string>());
  }

  void start(const toml::table& t, const std::string& path, const std::string& robots) {
    const std::string far = fmt::format("allowed: -{0:g} to {0:g}", kFarthest_m);
    const auto x_m = keys_.number(t, path, "x_m", -kFarthest_m, kFarthest_m, false, far);
    const auto y_m = keys_.number(t, path, "y_m", -kFarthest_m, kFarthest_m, false, far);
    const auto yaw = keys_.number(t, path, "yaw_deg", -360.0, 360.0, false, "allowed: -360 to 360");
    if (!x_m && !y_m && !yaw) return;
    for (const std::string_view key : {"x_m", "y_m"})
      if (t.get(key) == nullptr) keys_.missing(t, path, key, "where it stands, in m");
    if (x_m && y_m) add("start", robots, fmt::format("{},{},{}", *x_m, *y_m, yaw.value_or(0.0)));
  }

  void fault(const toml::table& t, const std::string& path) {
    const std::string id = ids(t, path, "robots");
    const bool other = is_opponent(t, path);
    std::string inside;
    for (const auto& [key, node] : t) {
      if (key.str() == "robots" || key.str() == "team") continue;
      inside += fmt::format("{}{} = ", inside.empty() ? "" : ", ", key.str());
      if (!as_text(node, inside))
        return keys_.wrong(node, key_path(path, key.str()), "has no value of a fault",
                           "allowed: a text, a number, true, false or a list of them");
    }
    std::vector<std::string> wrong;
    read_fault(inside, wrong);
    for (const std::string& problem : wrong)
      problems_.push_back({document_.file, static_cast<int>(t.source().begin.line),
                           static_cast<int>(t.source().begin.column), path, "", problem, ""});
    if (wrong.empty() && !id.empty())
      out_.arguments.push_back(fmt::format("--fault={}{}: {}", other ? "opponents:" : "", id, inside));
  }

  const ModelDocument& document_;
  const std::function<std::string(const std::string&)>& beside_;
  std::vector<ModelProblem>& problems_;
  TomlKeys keys_;
  std::string team_ = "blue";
  BenchRows out_;
};

}  // namespace

BenchRows bench_rows(const ModelDocument& document,
                     const std::function<std::string(const std::string&)>& beside,
                     std::vector<ModelProblem>& problems) {
  return Rows(document, beside, problems).read();
}

}  // namespace omnihil
