#include "tools/options/bench_expansion.h"

#include <algorithm>
#include <filesystem>
#include <set>

#include "hil/text/text_file.h"
#include "tools/options/bench_file.h"

namespace omnihil {
namespace {

// The value of --bench, and where it stands; empty where it does not.
std::string bench_of(const std::vector<std::string>& arguments) {
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (arguments[i].starts_with("--bench=")) return arguments[i].substr(8);
    if (arguments[i] == "--bench" && i + 1 < arguments.size()) return arguments[i + 1];
  }
  return {};
}

std::set<std::string> names_given(const std::vector<std::string>& arguments) {
  std::set<std::string> names;
  for (const std::string& word : arguments) {
    if (word.starts_with("--")) names.insert(word.substr(2, word.find('=') - 2));
  }
  return names;
}

// What a verb takes of a bench: all that it knows, but of a recording, which has the rest, what is not in it.
bool takes(const std::string& verb, const CLI::App& app, const std::string& argument) {
  const std::string name = argument.substr(2, argument.find('=') - 2);
  static const std::set<std::string> kNotRecorded{"firmware",       "board",  "firmware-deadline",
                                                  "firmware-of",    "format", "opponents-firmware",
                                                  "opponents-board"};
  if ((verb == "replay" || verb == "check") && !kNotRecorded.contains(name)) return false;
  return app.get_option_no_throw("--" + name) != nullptr;
}

const CLI::App* find_verb(const CLI::App& app, const std::string& name) {
  for (const CLI::App* each : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (each->get_name() == name) return each;
  }
  return nullptr;
}

}  // namespace

std::string expand_bench(std::vector<std::string>& arguments, const CLI::App& app) {
  const std::string file = bench_of(arguments);
  if (file.empty() || arguments.empty()) return {};
  const CLI::App* verb = find_verb(app, arguments.front());
  if (verb != nullptr && arguments.size() > 1) {  // scenario run
    if (const CLI::App* inner = find_verb(*verb, arguments[1])) verb = inner;
  }
  const CLI::App* serve = find_verb(app, "serve");
  if (verb == nullptr || serve == nullptr || verb->get_option_no_throw("--bench") == nullptr) return {};
  std::string error;
  const std::string text = read_text_file(file, error);
  if (!error.empty()) return "bench " + file + ": " + error;
  std::vector<BenchOption> options;
  for (const CLI::Option* option : serve->get_options()) {
    for (const std::string& name : option->get_lnames()) {
      if (name != "help") options.push_back({name, option->get_items_expected_max() == 0});
    }
  }
  const BenchArguments read = bench_arguments(text, file, std::filesystem::path(file).parent_path().string(),
                                              options, names_given(arguments));
  std::string problems;
  for (const ModelProblem& problem : read.problems)
    problems += (problems.empty() ? "" : "\n") + problem.text();
  if (!problems.empty()) return problems;
  // Behind what was given: an option of several values would take the words that follow it.
  for (const std::string& argument : read.arguments)
    if (takes(verb->get_name(), *verb, argument)) arguments.push_back(argument);
  return {};
}

}  // namespace omnihil
