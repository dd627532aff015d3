#include "tools/misspelt.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "sim/law/spelling.h"

namespace omnihil {
namespace {

// A dash and no number: "--robts", "-x", not "-1.5".
bool is_option(const std::string& word) {
  return word.size() > 1 && word[0] == '-' &&
         std::string_view("0123456789.").find(word[1]) == std::string::npos;
}

std::string unknown_verb(const Command& command, const std::string& word) {
  std::vector<std::string_view> known;
  for (const Command& verb : command.verbs) known.push_back(verb.name);
  const std::string_view near = nearest_spelling(word, known);
  return fmt::format("{}: there is no verb \"{}\"; {}\n", command.words, word,
                     near.empty() ? fmt::format("`{} --help` lists them", command.words)
                                  : fmt::format("did you mean \"{}\"?", near));
}

std::string unknown_option(const Command& command, const std::string& word) {
  const std::string option = word.substr(0, word.find('='));
  const std::size_t dashes = std::min(option.find_first_not_of('-'), option.size());
  std::vector<std::string_view> known;
  for (const CommandOption& o : command.options) {
    known.insert(known.end(), o.long_names.begin(), o.long_names.end());
  }
  const std::string_view near = nearest_spelling(std::string_view(option).substr(dashes), known);
  return fmt::format("{}: there is no option {}; {}\n", command.words, option,
                     near.empty() ? fmt::format("`{} --help` lists them", command.words)
                                  : fmt::format("did you mean --{}?", near));
}

}  // namespace

std::string misspelt_words(const Command& command) {
  const auto verb =
      std::find_if(command.verbs.begin(), command.verbs.end(), [](const Command& v) { return v.called; });
  if (!command.verbs.empty() && verb == command.verbs.end()) {
    const auto word = std::find_if_not(command.left.begin(), command.left.end(), is_option);
    if (word != command.left.end()) return unknown_verb(command, *word);  // what follows it belongs to it
  }
  std::string text;
  for (const std::string& word : command.left) {
    if (is_option(word) && word != "--") text += unknown_option(command, word);
  }
  return verb == command.verbs.end() ? text : text + misspelt_words(*verb);
}

}  // namespace omnihil
