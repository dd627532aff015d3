// The command line as a verb sees it: words bound to variables. command_line.cc alone knows the parser (CLI11), whose
// header costs 6 s of compilation in every file that includes it.
//
//   Verb verb = program.add_subcommand("sim", "a virtual bench: drive a model, write a dataset");
//   verb.add_option("MODEL", model, "name or file").required();
//   verb.add_option("--step", step_ms, "loop step in ms").range(0.05, 100.0).capture_default_str();
//   verb.callback([&] { … });
//
// Verb and Option are handles, copied freely; what they stand for lives as long as the program's parser.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace omnihil {

class Option {
 public:
  explicit Option(CLI::Option* option) : option_(option) {}
  Option& required();
  Option& capture_default_str();  // help prints the variable's value of now
  Option& type_name(const std::string& name);
  Option& excludes(const Option& other);
  Option& range(double low, double high);
  Option& range(int low, int high);
  Option& range(std::int64_t low, std::int64_t high);
  Option& positive();
  Option& not_negative();
  Option& one_of(const std::vector<std::string>& words);

 private:
  CLI::Option* option_;
};

// What an option is set to now: on the command line, or by itself.
struct OptionSetting {
  std::string name;  // without the dashes
  bool is_flag = false, is_list = false;
  std::vector<std::string> values;  // as texts; none: not set. Of a flag that is set, one
};

class Verb {
 public:
  explicit Verb(CLI::App* app) : app_(app) {}
  Verb add_subcommand(const std::string& name, const std::string& what);
  // T: the types that command_line.cc names; another one is a line there.
  template <typename T>
  Option add_option(const std::string& name, T& value, const std::string& what);
  Option add_flag(const std::string& name, bool& value, const std::string& what);
  void footer(const std::string& text);
  void callback(std::function<void()> run);
  void require_subcommand(int count);
  std::vector<OptionSetting> settings() const;  // of all options, in their order

 private:
  CLI::App* app_;
};

}  // namespace omnihil
