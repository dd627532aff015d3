#include "tools/man_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

namespace omnihil {
namespace {

// Text as roff takes it: no control line, no escape, hyphens that can be searched for.
std::string roff(const std::string& text) {
  std::string out;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (!out.empty()) out += '\n';
    if (line.starts_with('.') || line.starts_with('\'')) out += "\\&";
    for (const char c : line) out += c == '\\' ? "\\e" : c == '-' ? "\\-" : std::string(1, c);
  }
  return out;
}

// A line may break behind each comma: a list of words that are allowed is longer than one.
std::string breakable(const std::string& head) {
  std::string out;
  for (const char c : head) out += c == ',' ? std::string(",\\:") : std::string(1, c);
  return out;
}

std::string item(const std::string& head, const std::string& text) {
  return fmt::format(".TP\n.B {}\n{}\n", breakable(roff(head)), roff(text));
}

std::string usage_text(const Command& command) {
  return fmt::format(".B {}\n{}\n", roff(command.words), roff(command.usage));
}

std::string rows_text(const std::string& macro, const char* title, const std::vector<CommandOption>& rows) {
  if (rows.empty()) return "";
  std::string out = macro + " " + title + "\n";
  for (const CommandOption& row : rows) out += item(row.names + row.value, row.description);
  return out;
}

std::string options_text(const Command& command, const std::string& macro) {
  return rows_text(macro, "ARGUMENTS", command.arguments) + rows_text(macro, "OPTIONS", command.options);
}

std::string see_also(const Command& command) {
  std::string pages;
  if (command.words != "omnihil") return ".BR omnihil (1)\n";
  for (const Command& verb : command.verbs) {
    pages += fmt::format("{}.BR {} (1)", pages.empty() ? "" : ",\n", roff(man_page_name(verb)));
  }
  return pages + "\n";
}

}  // namespace

std::string man_page_name(const Command& command) {
  std::string name = command.words;
  std::replace(name.begin(), name.end(), ' ', '-');
  return name;
}

std::string man_page(const Command& command, const std::string& version) {
  const std::string name = man_page_name(command);
  std::string description = command.description;
  if (description.starts_with(name + ": ")) description.erase(0, name.size() + 2);
  std::string out =
      fmt::format(".TH {} 1 \"\" \"omnihil {}\" \"omnihil\"\n.SH NAME\n{} \\- {}\n.SH SYNOPSIS\n", roff(name),
                  roff(version), roff(name), roff(description));
  // The program's verbs have pages of their own.
  const bool whole = command.words == "omnihil";
  const std::vector<const Command*> below = whole ? std::vector<const Command*>{} : all_below(command);
  out += usage_text(command);
  for (const Command* verb : below) out += ".br\n" + usage_text(*verb);
  out += options_text(command, ".SH");
  if (!command.verbs.empty()) out += ".SH VERBS\n";
  for (const Command& verb : command.verbs) out += item(verb.name, verb.description);
  for (const Command* verb : below) {
    out +=
        fmt::format(".SH {}\n{}\n{}", roff(verb->words), roff(verb->description), options_text(*verb, ".SS"));
  }
  out +=
      fmt::format(".SH EXIT STATUS\n.nf\n{}\n.fi\n.SH SEE ALSO\n{}", roff(command.footer), see_also(command));
  return out +
         ".PP\nPages of documentation stand in share/doc/omnihil/docs below the installation's prefix.\n";
}

}  // namespace omnihil
