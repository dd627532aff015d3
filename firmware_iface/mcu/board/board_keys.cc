#include "firmware_iface/mcu/board/board_keys.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace omnihil::mcu {
namespace {
std::string key_path(const std::string& path, std::string_view key) {
  return path.empty() ? std::string(key) : path + "." + std::string(key);
}

std::string written(const toml::node& node) {
  std::ostringstream out;
  node.visit([&out](const auto& value) { out << value; });
  std::string text = out.str();
  std::replace(text.begin(), text.end(), '\n', ' ');
  constexpr std::size_t kMost = 60;
  return text.size() <= kMost ? text : text.substr(0, kMost) + " …";
}
}  // namespace

std::string BoardProblem::text() const {
  std::string out = line > 0 ? fmt::format("{}:{}: ", file, line) : fmt::format("{}: ", file);
  if (!key.empty()) out += key;
  if (!value.empty()) out += " = " + value;
  if (!key.empty()) out += ": ";
  out += what;
  if (!allowed.empty()) out += "; allowed: " + allowed;
  return out;
}

void BoardKeys::wrong(const toml::table& table, const std::string& path, std::string_view key,
                      std::string what, std::string allowed) {
  const toml::node* node = table.get(key);
  const unsigned line = node != nullptr ? node->source().begin.line : table.source().begin.line;
  problems_.push_back({file_, line, key_path(path, key), node != nullptr ? written(*node) : "",
                       std::move(what), std::move(allowed)});
}

void BoardKeys::missing(const toml::table& table, const std::string& path, std::string_view key,
                        std::string allowed) {
  wrong(table, path, key, "missing", std::move(allowed));
}

void BoardKeys::only(const toml::table& table, const std::string& path,
                     std::initializer_list<std::string_view> allowed) {
  for (const auto& [key, node] : table) {
    if (std::find(allowed.begin(), allowed.end(), key.str()) != allowed.end()) continue;
    problems_.push_back({file_, key.source().begin.line, key_path(path, key.str()), written(node),
                         "unknown key", fmt::format("{}", fmt::join(allowed, ", "))});
  }
}

std::optional<std::string> BoardKeys::text(const toml::table& table, const std::string& path,
                                           std::string_view key) {
  const toml::node* node = table.get(key);
  if (node == nullptr) return std::nullopt;
  if (const auto value = node->value_exact<std::string>()) return *value;
  wrong(table, path, key, "not a text", "a text");
  return std::nullopt;
}

std::optional<std::size_t> BoardKeys::word(const toml::table& table, const std::string& path,
                                           std::string_view key,
                                           std::initializer_list<std::string_view> allowed, bool needed) {
  const std::string list = fmt::format("{}", fmt::join(allowed, ", "));
  if (needed && !table.contains(key)) missing(table, path, key, list);
  const auto value = text(table, path, key);
  if (!value) return std::nullopt;
  const auto* const found = std::find(allowed.begin(), allowed.end(), *value);
  if (found != allowed.end()) return static_cast<std::size_t>(found - allowed.begin());
  wrong(table, path, key, "unknown", list);
  return std::nullopt;
}

void BoardKeys::format(const toml::table& top, std::string_view allowed) {
  word(top, "", "format", {allowed}, true);
}

std::string BoardKeys::radio_format(const toml::table& radio, const ServedRadio& served) {
  const std::string format = text(radio, "radio", "format").value_or("");
  if (format.empty()) {
    missing(radio, "radio", "format", "a radio format, see `omnihil formats`");
    return format;
  }
  const auto is_known = [&served](const std::string& id) {
    return served.known.empty() || id == served.served ||
           std::find(served.known.begin(), served.known.end(), id) != served.known.end();
  };
  if (!is_known(format)) {
    wrong(radio, "radio", "format", "unknown", fmt::format("{}", fmt::join(served.known, ", ")));
  } else if (!served.served.empty() && format != served.served) {
    wrong(radio, "radio", "format",
          fmt::format("the bench serves \"{}\", no packet would reach the image (--radio {} serves this one)",
                      served.served, format),
          served.served);
  }
  return format;
}

std::optional<double> BoardKeys::number(const toml::table& table, const std::string& path,
                                        std::string_view key, double lower, double upper) {
  const toml::node* node = table.get(key);
  if (node == nullptr) return std::nullopt;
  const std::string allowed = fmt::format("a number from {} to {}", lower, upper);
  const auto value = node->is_number() ? node->value<double>() : std::nullopt;
  if (!value || !std::isfinite(*value) || *value < lower || *value > upper) {
    wrong(table, path, key, value ? "out of range" : "not a number", allowed);
    return std::nullopt;
  }
  return value;
}

std::optional<std::int64_t> BoardKeys::whole(const toml::table& table, const std::string& path,
                                             std::string_view key, std::int64_t lower, std::int64_t upper) {
  const toml::node* node = table.get(key);
  if (node == nullptr) return std::nullopt;
  const auto value = node->value_exact<std::int64_t>();
  if (!value || *value < lower || *value > upper) {
    wrong(table, path, key, value ? "out of range" : "not a whole number",
          fmt::format("{} to {}", lower, upper));
    return std::nullopt;
  }
  return value;
}

std::optional<bool> BoardKeys::flag(const toml::table& table, const std::string& path, std::string_view key) {
  const toml::node* node = table.get(key);
  if (node == nullptr) return std::nullopt;
  if (const auto value = node->value_exact<bool>()) return *value;
  wrong(table, path, key, "not a truth value", "true, false");
  return std::nullopt;
}

std::vector<std::string> BoardKeys::texts(const toml::table& table, const std::string& path,
                                          std::string_view key) {
  const toml::node* node = table.get(key);
  if (node == nullptr) return {};
  if (const auto one = node->value_exact<std::string>()) return {*one};
  std::vector<std::string> all;
  if (const toml::array* list = node->as_array()) {
    for (const toml::node& item : *list) {
      if (const auto value = item.value_exact<std::string>()) all.push_back(*value);
    }
    if (all.size() == list->size() && !all.empty()) return all;
  }
  wrong(table, path, key, "not a text or a list of texts", "\"TIM1.1\" or [\"TIM1.1\", \"TIM1.2\"]");
  return {};
}

std::vector<std::pair<const toml::table*, std::string>> BoardKeys::tables(const toml::table& table,
                                                                          const std::string& path,
                                                                          std::string_view name) {
  std::vector<std::pair<const toml::table*, std::string>> all;
  const toml::node* node = table.get(name);
  if (node == nullptr) return all;
  const toml::array* list = node->as_array();
  if (list == nullptr || !list->is_array_of_tables()) {
    wrong(table, path, name, "not a list of tables", fmt::format("[[{}]]", name));
    return all;
  }
  for (std::size_t i = 0; i < list->size(); ++i) {
    all.emplace_back(list->get(i)->as_table(), fmt::format("{}[{}]", key_path(path, name), i));
  }
  return all;
}

std::optional<toml::table> parse_board(std::string_view text, const std::string& file,
                                       std::vector<BoardProblem>& problems) {
  try {
    return toml::parse(text, file);
  } catch (const toml::parse_error& e) {
    problems.push_back(
        {file, e.source().begin.line, "", "", fmt::format("not TOML: {}", e.description()), ""});
    return std::nullopt;
  }
}

}  // namespace omnihil::mcu
