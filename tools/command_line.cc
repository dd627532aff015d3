#include "tools/command_line.h"

#include <CLI/CLI.hpp>
#include <optional>
#include <utility>

namespace omnihil {

Option& Option::required() {
  option_->required();
  return *this;
}

Option& Option::capture_default_str() {
  option_->capture_default_str();
  return *this;
}

Option& Option::type_name(const std::string& name) {
  option_->type_name(name);
  return *this;
}

Option& Option::excludes(const Option& other) {
  option_->excludes(other.option_);
  return *this;
}

Option& Option::range(double low, double high) {
  option_->check(CLI::Range(low, high));
  return *this;
}

Option& Option::range(int low, int high) {
  option_->check(CLI::Range(low, high));
  return *this;
}

Option& Option::range(std::int64_t low, std::int64_t high) {
  option_->check(CLI::Range(low, high));
  return *this;
}

Option& Option::positive() {
  option_->check(CLI::PositiveNumber);
  return *this;
}

Option& Option::not_negative() {
  option_->check(CLI::NonNegativeNumber);
  return *this;
}

Option& Option::one_of(const std::vector<std::string>& words) {
  option_->check(CLI::IsMember(words));
  return *this;
}

Verb Verb::add_subcommand(const std::string& name, const std::string& what) {
  return Verb(app_->add_subcommand(name, what));
}

template <typename T>
Option Verb::add_option(const std::string& name, T& value, const std::string& what) {
  return Option(app_->add_option(name, value, what));
}
template Option Verb::add_option(const std::string&, std::string&, const std::string&);
template Option Verb::add_option(const std::string&, std::vector<std::string>&, const std::string&);
template Option Verb::add_option(const std::string&, double&, const std::string&);
template Option Verb::add_option(const std::string&, int&, const std::string&);
template Option Verb::add_option(const std::string&, std::int64_t&, const std::string&);
template Option Verb::add_option(const std::string&, std::uint64_t&, const std::string&);
template Option Verb::add_option(const std::string&, std::optional<std::uint64_t>&, const std::string&);

Option Verb::add_flag(const std::string& name, bool& value, const std::string& what) {
  return Option(app_->add_flag(name, value, what));
}

void Verb::footer(const std::string& text) { app_->footer(text); }

void Verb::callback(std::function<void()> run) { app_->callback(std::move(run)); }

std::vector<OptionSetting> Verb::settings() const {
  std::vector<OptionSetting> settings;
  for (const CLI::Option* option : app_->get_options()) {
    if (option->get_lnames().empty()) continue;
    OptionSetting& setting = settings.emplace_back();
    setting.name = option->get_lnames().front();
    setting.is_flag = option->get_items_expected_max() == 0;
    setting.is_list = option->get_items_expected_max() > 1;
    if (option->count() > 0) {
      setting.values = option->results();
    } else if (!setting.is_flag && !option->get_default_str().empty()) {
      setting.values = {option->get_default_str()};
    }
  }
  return settings;
}

void Verb::require_subcommand(int count) { app_->require_subcommand(count); }

}  // namespace omnihil
