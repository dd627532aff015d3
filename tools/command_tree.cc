#include "tools/command_tree.h"

#include <CLI/CLI.hpp>
#include <algorithm>

namespace omnihil {
namespace {

// CLI11 names a check of membership by its values: "TEXT:{blue,yellow}".
std::vector<std::string> choices_of(const std::string& type) {
  const std::size_t begin = type.find(":{"), end = type.find('}', begin);
  if (begin == std::string::npos || end == std::string::npos) return {};
  return CLI::detail::split(type.substr(begin + 2, end - begin - 2), ',');
}

CommandOption option_of(const CLI::Option& o) {
  const CLI::Formatter help;
  CommandOption out;
  out.names = help.make_option_name(&o, o.get_positional());
  out.value = help.make_option_opts(&o);
  out.description = help.make_option_desc(&o);
  out.short_names = o.get_snames();
  out.long_names = o.get_lnames();
  out.takes_value = o.get_items_expected_max() > 0;  // a flag takes none
  out.choices = choices_of(o.get_type_name());
  return out;
}

std::string usage_of(const CLI::App& app, const std::string& words) {
  const std::string line = CLI::Formatter().make_usage(&app, words);  // "Usage: omnihil serve [OPTIONS]\n"
  const std::size_t end = line.find(words) + words.size();
  return CLI::detail::trim_copy(line.substr(end));
}

}  // namespace

Command command_tree(const CLI::App& app, const std::string& words) {
  Command out;
  out.words = words;
  out.name = app.get_name();
  out.description = app.get_description();
  out.usage = usage_of(app, words);
  out.footer = app.get_footer();
  out.called = app.parsed();
  out.left = app.remaining();
  for (const CLI::Option* o : app.get_options({})) {
    if (!o->get_group().empty()) (o->get_positional() ? out.arguments : out.options).push_back(option_of(*o));
  }
  for (const CLI::App* verb : app.get_subcommands({})) {
    if (!verb->get_group().empty()) out.verbs.push_back(command_tree(*verb, words + " " + verb->get_name()));
  }
  return out;
}

std::vector<const Command*> all_below(const Command& command) {
  std::vector<const Command*> all;
  for (const Command& verb : command.verbs) {
    all.push_back(&verb);
    const std::vector<const Command*> below = all_below(verb);
    all.insert(all.end(), below.begin(), below.end());
  }
  return all;
}

}  // namespace omnihil
