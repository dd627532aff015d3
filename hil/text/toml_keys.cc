#include "hil/text/toml_keys.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace omnihil {

std::string key_path(const std::string& path, std::string_view key) {
  return path.empty() ? std::string(key) : fmt::format("{}.{}", path, key);
}

std::string spelling_hint(std::string_view word, std::span<const std::string_view> allowed) {
  const std::string_view near = nearest_spelling(word, allowed);
  if (!near.empty()) return fmt::format("did you mean \"{}\"?", near);
  return fmt::format("allowed: {}", fmt::join(allowed, ", "));
}

void TomlKeys::wrong(const toml::node& node, const std::string& key, std::string what, std::string allowed) {
  problems_.push_back(problem_at(document_, node.source(), key, document_.written(node), std::move(what),
                                 std::move(allowed)));
}

void TomlKeys::wrong_key(const toml::key& key, const std::string& path, std::string what,
                         std::string allowed) {
  problems_.push_back(problem_at(document_, key.source(), path, "", std::move(what), std::move(allowed)));
}

void TomlKeys::only(const toml::table& table, const std::string& path,
                    std::span<const std::string_view> allowed) {
  for (const auto& [key, node] : table) {
    const std::string_view name = key.str();
    if (std::find(allowed.begin(), allowed.end(), name) != allowed.end()) continue;
    wrong_key(key, key_path(path, name), "unknown key", spelling_hint(name, allowed));
  }
}

std::optional<std::string> TomlKeys::text(const toml::table& table, const std::string& path,
                                          std::string_view key) {
  const toml::node* node = table.get(key);
  if (node == nullptr) return std::nullopt;
  if (node->is_string() && !node->as_string()->get().empty()) return node->as_string()->get();
  if (node->is_string()) {
    wrong(*node, key_path(path, key), "is empty", "a text is needed");
  } else {
    wrong(*node, key_path(path, key), fmt::format("is {}", kind_of(*node)), "a text is needed");
  }
  return std::nullopt;
}

std::optional<double> TomlKeys::number(const toml::table& table, const std::string& path,
                                       std::string_view key, double lower, double upper, bool above_lower,
                                       const std::string& allowed) {
  const toml::node* node = table.get(key);
  if (node == nullptr) return std::nullopt;
  if (!node->is_number()) {
    wrong(*node, key_path(path, key), fmt::format("is {}", kind_of(*node)), allowed);
    return std::nullopt;
  }
  const double value = *node->value<double>();
  if (std::isfinite(value) && (above_lower ? value > lower : value >= lower) && value <= upper) return value;
  wrong(*node, key_path(path, key), "is out of range", allowed);
  return std::nullopt;
}

std::optional<std::size_t> TomlKeys::word(const toml::table& table, const std::string& path,
                                          std::string_view key, std::span<const std::string_view> allowed,
                                          std::optional<std::size_t> otherwise) {
  const toml::node* node = table.get(key);
  if (node == nullptr) return otherwise;
  if (node->is_string()) {
    const auto found = std::find(allowed.begin(), allowed.end(), node->as_string()->get());
    if (found != allowed.end()) return static_cast<std::size_t>(found - allowed.begin());
  }
  wrong(*node, key_path(path, key), "is not allowed here",
        fmt::format("allowed: \"{}\"", fmt::join(allowed, "\", \"")));
  return std::nullopt;
}

void TomlKeys::missing(const toml::node& where, const std::string& path, std::string_view key,
                       const std::string& allowed) {
  problems_.push_back(
      problem_at(document_, where.source(), key_path(path, key), "", "is missing", "needed: " + allowed));
}

}  // namespace omnihil
