#include "sim/model/model_document.h"

#include <fmt/format.h>

#include <algorithm>

namespace omnihil {
namespace {

// TOML columns count characters, strings count bytes.
std::size_t byte_of_column(const std::string& line, std::uint32_t column) {
  std::size_t byte = 0;
  for (std::uint32_t character = 1; byte < line.size() && character < column; ++character) {
    do ++byte;
    while (byte < line.size() && (static_cast<unsigned char>(line[byte]) & 0xC0u) == 0x80u);
  }
  return byte;
}

}  // namespace

std::string ModelProblem::text() const {
  std::string out = line > 0 ? fmt::format("{}:{}:{}: ", file, line, column) : fmt::format("{}: ", file);
  if (!key.empty()) out += key;
  if (!value.empty()) out += " = " + value;
  if (!key.empty() || !value.empty()) out += ": ";
  out += what;
  if (!allowed.empty()) out += "; " + allowed;
  return out;
}

std::string lines_of(const std::vector<ModelProblem>& problems) {
  std::string text;
  for (const ModelProblem& problem : problems) text += (text.empty() ? "" : "\n") + problem.text();
  return text;
}

std::string ModelDocument::written(const toml::node& node) const {
  const toml::source_region& s = node.source();
  if (s.begin.line == 0 || s.begin.line > lines.size()) return "";
  const std::string& line = lines[s.begin.line - 1];
  const std::size_t from = byte_of_column(line, s.begin.column);
  const bool one_line = s.end.line == s.begin.line;
  const std::size_t to = one_line ? byte_of_column(line, s.end.column) : line.size();
  std::string out = line.substr(from, to > from ? to - from : 0);
  while (!out.empty() && (out.back() == ' ' || out.back() == '\r')) out.pop_back();
  return one_line ? out : out + " …";
}

std::optional<ModelDocument> parse_document(std::string_view text, const std::string& file,
                                            std::vector<ModelProblem>& problems) {
  ModelDocument document{.file = file, .lines = {}, .table = {}};
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t to = std::min(text.find('\n', from), text.size());
    document.lines.emplace_back(text.substr(from, to - from));
    from = to + 1;
  }
  try {
    document.table = toml::parse(text, file);
  } catch (const toml::parse_error& e) {
    problems.push_back(problem_at(document, e.source(), "", "", fmt::format("not TOML: {}", e.description()),
                                  "further problems show once this is mended"));
    return std::nullopt;
  }
  return document;
}

std::string_view kind_of(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::string:
      return "a text";
    case toml::node_type::integer:
    case toml::node_type::floating_point:
      return "a number";
    case toml::node_type::boolean:
      return "true or false";
    case toml::node_type::array:
      return "a list";
    case toml::node_type::table:
      return "a table";
    default:
      return "a date or time";
  }
}

ModelProblem problem_at(const ModelDocument& document, const toml::source_region& where, std::string key,
                        std::string value, std::string what, std::string allowed) {
  return {.file = document.file,
          .line = std::max(1, static_cast<int>(where.begin.line)),
          .column = std::max(1, static_cast<int>(where.begin.column)),
          .key = std::move(key),
          .value = std::move(value),
          .what = std::move(what),
          .allowed = std::move(allowed)};
}

}  // namespace omnihil
