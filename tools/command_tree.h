// The tree of verbs as the user sees it, as plain data: what `--help` shows, in its words and order, and what the
// command line left over. Whoever writes pages or advice from it needs no header of CLI11.
//
//   const Command program = command_tree(app);
//   program.verbs[0].words;                   // "omnihil add"
//   program.verbs[0].options[0].names;        // "-h,--help"
#pragma once
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace omnihil {

struct CommandOption {
  std::string names;  // "-h,--help"; an argument's: "DATASET"
  std::string value;  // " TEXT:{blue,yellow}=blue", as --help says it; empty: a flag
  std::string description;
  std::vector<std::string> short_names, long_names;  // without dashes
  std::vector<std::string> choices;                  // between which its user chooses; empty: other values
  bool takes_value = false;
};

struct Command {
  std::string words;  // "omnihil scenario run"
  std::string name;   // "run"
  std::string description;
  std::string usage;  // what follows the words: "[OPTIONS] [PATH...]"
  std::string footer;
  std::vector<CommandOption> arguments, options;
  std::vector<Command> verbs;     // without the hidden ones
  bool called = false;            // it stood on the command line
  std::vector<std::string> left;  // words that it was given and does not know
};

Command command_tree(const CLI::App& app, const std::string& words = "omnihil");

// The commands below `command`, depth first.
std::vector<const Command*> all_below(const Command& command);

}  // namespace omnihil
