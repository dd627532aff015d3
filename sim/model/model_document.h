// One parsed TOML text and where its parts stand: what messages need to name line, column and value.
#pragma once
#include <toml++/toml.h>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/model/model_file.h"

namespace omnihil {

struct ModelDocument {
  std::string file;
  std::vector<std::string> lines;
  toml::table table;

  // The text of a value as written; several lines are shortened to the first.
  std::string written(const toml::node& node) const;
};

// Empty, with one problem added, when the text is not TOML (a TOML parser stops at the first fault).
std::optional<ModelDocument> parse_document(std::string_view text, const std::string& file,
                                            std::vector<ModelProblem>& problems);

// "a text", "a number", "a table": what a node is, for people.
std::string_view kind_of(const toml::node& node);

ModelProblem problem_at(const ModelDocument& document, const toml::source_region& where, std::string key,
                        std::string value, std::string what, std::string allowed);

}  // namespace omnihil
