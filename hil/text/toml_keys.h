// Walks a TOML table of known keys and says what is wrong with each, with its place.
//
//   TomlKeys keys(document, problems);
//   const std::string_view known[] = {"format", "title"};
//   keys.only(table, "", known);                                 // unknown keys, with the nearest spelling
//   std::optional<std::string> title = keys.text(table, "", "title");
#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sim/model/model_document.h"

namespace omnihil {

class TomlKeys {
 public:
  TomlKeys(const ModelDocument& document, std::vector<ModelProblem>& problems)
      : document_(document), problems_(problems) {}

  // `path` names the table in messages: "channels.duty", "runs[2]"; empty: the top.
  void only(const toml::table& table, const std::string& path, std::span<const std::string_view> allowed);
  std::optional<std::string> text(const toml::table& table, const std::string& path, std::string_view key);
  std::optional<double> number(const toml::table& table, const std::string& path, std::string_view key,
                               double lower, double upper, bool above_lower, const std::string& allowed);
  // The index of the word among `allowed`; `otherwise` where the key is absent, none where it is wrong.
  std::optional<std::size_t> word(const toml::table& table, const std::string& path, std::string_view key,
                                  std::span<const std::string_view> allowed,
                                  std::optional<std::size_t> otherwise);
  void missing(const toml::node& where, const std::string& path, std::string_view key,
               const std::string& allowed);
  void wrong(const toml::node& node, const std::string& key, std::string what, std::string allowed);
  void wrong_key(const toml::key& key, const std::string& path, std::string what, std::string allowed);

 private:
  const ModelDocument& document_;
  std::vector<ModelProblem>& problems_;
};

std::string key_path(const std::string& path, std::string_view key);

// "did you mean \"velocity\"?", or "allowed: …"
std::string spelling_hint(std::string_view word, std::span<const std::string_view> allowed);

}  // namespace omnihil
