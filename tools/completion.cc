#include "tools/completion.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string_view>
#include <vector>

namespace omnihil {
namespace {

// Options and arguments whose values the program lists: the first word of each line of `omnihil VERB`, to the
// first empty one.
struct Listed {
  std::string_view command;  // empty: any
  std::string_view names;
  std::string_view verb;
};
constexpr Listed kListed[] = {
    {"", "--robot", "models"},
    {"", "--with", "effects"},
    {"", "--radio", "formats"},
    {"", "FORMAT", "formats"},
    {"omnihil formats", "ID", "formats"},
    {"omnihil effects", "ID", "effects"},
    {"omnihil models", "MODEL", "models"},
    {"omnihil sim", "MODEL", "models"},
};

std::string_view listing_verb(const Command& command, const CommandOption& option) {
  for (const Listed& row : kListed) {
    if ((row.command.empty() || row.command == command.words) && row.names == option.names) return row.verb;
  }
  return {};
}

std::vector<std::string> dashed(const CommandOption& o) {
  std::vector<std::string> words;
  for (const std::string& s : o.short_names) words.push_back("-" + s);
  for (const std::string& l : o.long_names) words.push_back("--" + l);
  return words;
}

std::vector<std::string> names_of(const std::vector<Command>& verbs) {
  std::vector<std::string> names;
  names.reserve(verbs.size());
  for (const Command& verb : verbs) names.push_back(verb.name);
  return names;
}

std::string bash_values(const std::vector<std::string>& values, std::string_view verb) {
  if (!values.empty()) return fmt::format("words='{}'", fmt::join(values, " "));
  return verb.empty() ? "words=" : fmt::format("words=$(_omnihil_names {})", verb);
}

// The parts of bash's function for one command: rows of its three `case`s.
struct BashRows {
  std::string verbs, values, words;

  void add(const Command& command) {
    for (const Command& verb : command.verbs) verbs += fmt::format("'{}' | ", verb.words);
    std::vector<std::string> options;
    for (const CommandOption& o : command.options) {
      const std::vector<std::string> names = dashed(o);
      options.insert(options.end(), names.begin(), names.end());
      if (!o.takes_value) continue;
      for (const std::string& name : names) {
        values += fmt::format("    '{} {}') {} ;;\n", command.words, name,
                              bash_values(o.choices, listing_verb(command, o)));
      }
    }
    const std::string_view listing =
        command.arguments.empty() ? "" : listing_verb(command, command.arguments.front());
    words += fmt::format("        '{}') options='{}'; {} ;;\n", command.words, fmt::join(options, " "),
                         bash_values(names_of(command.verbs), listing));
  }
};

constexpr const char* kBash = R"(# bash completion for omnihil, written by the program itself
_omnihil_names() {{ "${{COMP_WORDS[0]}}" "$1" 2>/dev/null | sed '/^$/,$d; s/ .*//'; }}
_omnihil() {{
  local cur=${{COMP_WORDS[COMP_CWORD]}} prev=${{COMP_WORDS[COMP_CWORD - 1]}} command=omnihil i words options
  for ((i = 1; i < COMP_CWORD; i++)); do
    case "$command ${{COMP_WORDS[i]}}" in
      {}'') command+=" ${{COMP_WORDS[i]}}" ;;
    esac
  done
  case "$command $prev" in
{}    *)
      case $command in
{}      esac
      [[ $cur != -* ]] || words=$options
      ;;
  esac
  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$cur")
}}
complete -o default -F _omnihil omnihil
)";

std::string fish_quoted(std::string text) {
  for (std::size_t at = 0; (at = text.find_first_of("\\'", at)) != std::string::npos; at += 2) {
    text.insert(at, "\\");
  }
  return "'" + text + "'";
}

// `omnihil scenario run`: that both verbs stand on the line.
std::string fish_condition(std::string_view words) {
  std::string out;
  for (std::size_t at; (at = words.find(' ')) != std::string_view::npos;) {
    words.remove_prefix(at + 1);
    out += fmt::format("{}__fish_seen_subcommand_from {}", out.empty() ? "" : "; and ",
                       words.substr(0, words.find(' ')));
  }
  return out.empty() ? "__fish_use_subcommand" : out;
}

std::string fish_option(const Command& command, const CommandOption& o) {
  std::string line = fmt::format("complete -c omnihil -n '{}'", fish_condition(command.words));
  for (const std::string& s : o.short_names) line += " -s " + s;
  for (const std::string& l : o.long_names) line += " -l " + l;
  if (o.takes_value) line += " -r";
  if (!o.choices.empty()) line += fmt::format(" -f -a '{}'", fmt::join(o.choices, " "));
  if (const std::string_view verb = listing_verb(command, o); !verb.empty()) {
    line += fmt::format(" -a '(omnihil {} 2>/dev/null | sed \"/^\\$/,\\$d; s/ .*//\")'", verb);
  }
  return line + " -d " + fish_quoted(o.description) + "\n";
}

}  // namespace

std::string bash_completion(const Command& program) {
  BashRows rows;
  rows.add(program);
  for (const Command* command : all_below(program)) rows.add(*command);
  return fmt::format(kBash, rows.verbs, rows.values, rows.words);
}

std::string fish_completion(const Command& program) {
  std::vector<const Command*> commands = all_below(program);
  commands.insert(commands.begin(), &program);
  std::string out = "# fish completion for omnihil, written by the program itself\n";
  for (const Command* command : commands) {
    for (const Command& verb : command->verbs) {
      out += fmt::format("complete -c omnihil -n '{}' -a {} -d {}\n", fish_condition(command->words),
                         verb.name, fish_quoted(verb.description));
    }
    for (const CommandOption& o : command->options) out += fish_option(*command, o);
  }
  return out;
}

}  // namespace omnihil
