#include "tools/options/bench_file.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <sstream>

#include "hil/text/toml_keys.h"
#include "tools/options/bench_robots.h"

namespace omnihil {
namespace {

// The names of these are files, or may be.
constexpr std::array<std::string_view, 10> kFiles{
    "robot",           "firmware",           "board",          "format", "record", "bench", "from",
    "opponents-robot", "opponents-firmware", "opponents-board"};

std::string dashed(std::string_view key) {
  std::string name(key);
  std::ranges::replace(name, '_', '-');
  return name;
}

class Reader {
 public:
  Reader(const ModelDocument& document, std::string folder, std::span<const BenchOption> options,
         const std::set<std::string>& given, BenchArguments& out)
      : keys_(document, out.problems),
        folder_(std::move(folder)),
        options_(options),
        given_(given),
        out_(out) {}

  void read(const ModelDocument& document) {
    read_rows(document);
    for (const auto& [key, node] : document.table) {
      if (key.str() == "format") continue;
      if ((key.str() == "robot" || key.str() == "fault") && node.is_array_of_tables()) continue;
      if (const toml::table* table = node.as_table()) {
        if (const BenchOption* flag = find(dashed(key.str())); flag != nullptr && flag->is_flag)
          add_flag(flag->name);
        for (const auto& [inner, value] : *table)
          take(inner, std::string(key.str()), name_within(dashed(key.str()), dashed(inner.str())), value);
        continue;
      }
      take(key, "", top_name(key.str()), node);
    }
  }

 private:
  // The key "format" says what file this is, [[robot]] are single ones: two names of their own.
  static std::string top_name(std::string_view key) {
    return key == "radio_file" ? "format" : key == "model" ? "robot" : dashed(key);
  }

  // [opponents] robots is --opponents, as robots is --robots.
  std::string name_within(const std::string& table, const std::string& key) const {
    const BenchOption* whole = find(table);
    return key == "robots" && whole != nullptr && !whole->is_flag ? table : table + "-" + key;
  }

  void read_rows(const ModelDocument& document) {
    const auto found = [this](const std::string& value) { return beside("robot", value); };
    const BenchRows rows = bench_rows(document, found, out_.problems);
    const auto join = [&](const std::vector<std::string>& ids, const char* name, bool said) {
      std::string list;
      for (const std::string& id : ids) list += (list.empty() ? "" : ",") + id;
      if (!list.empty() && !said && !given_.contains(name))
        out_.arguments.push_back("--" + std::string(name) + "=" + list);
    };
    const toml::node* opponents = document.table.get("opponents");
    join(rows.own, "robots", document.table.contains("robots"));
    join(rows.opponents, "opponents",
         opponents != nullptr && (!opponents->is_table() || opponents->as_table()->contains("robots")));
    for (const std::string& argument : rows.arguments) {
      if (!given_.contains(argument.substr(2, argument.find('=') - 2))) out_.arguments.push_back(argument);
    }
  }

  const BenchOption* find(const std::string& name) const {
    const auto at = std::ranges::find(options_, name, &BenchOption::name);
    return at == options_.end() || name == "bench" ? nullptr : &*at;
  }

  void add_flag(const std::string& name) {
    if (!given_.contains(name)) out_.arguments.push_back("--" + name);
  }

  void take(const toml::key& key, const std::string& path, const std::string& name, const toml::node& node) {
    const BenchOption* option = find(name);
    if (option == nullptr) {
      std::vector<std::string_view> names;
      for (const BenchOption& each : options_) names.push_back(each.name);
      keys_.wrong_key(key, path, "\"" + std::string(key.str()) + "\" is no option of serve",
                      spelling_hint(name, names));
      return;
    }
    if (option->is_flag) {
      if (!node.is_boolean())
        return keys_.wrong(node, key_path(path, key.str()), "is a flag", "true or false");
      if (node.as_boolean()->get()) add_flag(name);
      return;
    }
    if (given_.contains(name)) return;
    if (const toml::array* list = node.as_array()) {
      for (const toml::node& item : *list) add_value(key, path, name, item);
    } else {
      add_value(key, path, name, node);
    }
  }

  void add_value(const toml::key& key, const std::string& path, const std::string& name,
                 const toml::node& node) {
    std::ostringstream text;
    if (const auto* word = node.as_string()) {
      text << beside(name, word->get());
    } else if (const auto* whole = node.as_integer()) {
      text << whole->get();
    } else if (const auto* number = node.as_floating_point()) {
      text << fmt::format("{}", number->get());  // the shortest that gives the same number back
    } else {
      return keys_.wrong(node, key_path(path, key.str()), "has no value for an option",
                         "a text, a number or a list of them");
    }
    out_.arguments.push_back("--" + name + "=" + text.str());
  }

  std::string beside(const std::string& name, const std::string& value) const {
    if (folder_.empty() || std::ranges::find(kFiles, name) == kFiles.end()) return value;
    const std::filesystem::path here = std::filesystem::path(folder_) / value;
    std::error_code error;
    return std::filesystem::exists(here, error) ? here.string() : value;
  }

  TomlKeys keys_;
  std::string folder_;
  std::span<const BenchOption> options_;
  const std::set<std::string>& given_;
  BenchArguments& out_;
};

}  // namespace

BenchArguments bench_arguments(const std::string& text, const std::string& file, const std::string& folder,
                               std::span<const BenchOption> options, const std::set<std::string>& given) {
  BenchArguments out;
  const auto document = parse_document(text, file, out.problems);
  if (!document) return out;
  TomlKeys keys(*document, out.problems);
  const std::string_view formats[] = {kBenchFormat};
  if (!document->table.contains("format")) {
    keys.missing(document->table, "", "format", kBenchFormat);
  } else {
    keys.word(document->table, "", "format", formats, {});
  }
  Reader(*document, folder, options, given, out).read(*document);
  std::ranges::stable_sort(out.problems, {}, &ModelProblem::line);
  if (!out.problems.empty()) out.arguments.clear();
  return out;
}

}  // namespace omnihil
