// Walks the tables of a board file and collects what is wrong with each key.
#pragma once
#include <toml++/toml.h>

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "firmware_iface/mcu/board/board_context.h"
#include "firmware_iface/mcu/board/board_problem.h"

namespace omnihil::mcu {

class BoardKeys {
 public:
  BoardKeys(std::string file, std::vector<BoardProblem>& problems)
      : file_(std::move(file)), problems_(problems) {}

  void only(const toml::table& table, const std::string& path,
            std::initializer_list<std::string_view> allowed);
  std::optional<std::string> text(const toml::table& table, const std::string& path, std::string_view key);
  std::optional<double> number(const toml::table& table, const std::string& path, std::string_view key,
                               double lower, double upper);
  std::optional<std::int64_t> whole(const toml::table& table, const std::string& path, std::string_view key,
                                    std::int64_t lower, std::int64_t upper);
  // The index of the word among those allowed; none where it is absent or wrong. `needed`: it may not be absent.
  std::optional<std::size_t> word(const toml::table& table, const std::string& path, std::string_view key,
                                  std::initializer_list<std::string_view> allowed, bool needed = false);
  std::optional<bool> flag(const toml::table& table, const std::string& path, std::string_view key);
  // A text or a list of texts.
  std::vector<std::string> texts(const toml::table& table, const std::string& path, std::string_view key);
  void wrong(const toml::table& table, const std::string& path, std::string_view key, std::string what,
             std::string allowed);
  // The key "format" at the top, which says what file it is.
  void format(const toml::table& top, std::string_view allowed);
  // The key "format" of [radio]: one that there is, and the one that is served.
  std::string radio_format(const toml::table& radio, const ServedRadio& served);
  std::vector<BoardProblem>& problems() { return problems_; }
  void missing(const toml::table& table, const std::string& path, std::string_view key, std::string allowed);
  // The tables of `[[name]]`, each with its path; anything else is a problem.
  std::vector<std::pair<const toml::table*, std::string>> tables(const toml::table& table,
                                                                 const std::string& path,
                                                                 std::string_view name);

 private:
  std::string file_;
  std::vector<BoardProblem>& problems_;
};

// The text of a board file as TOML; what is not TOML is a problem with its line.
std::optional<toml::table> parse_board(std::string_view text, const std::string& file,
                                       std::vector<BoardProblem>& problems);

// What a Reader of (table, file, problems, context) makes of a board file; nothing where it has a problem.
template <typename Reader>
auto read_board_by(std::string_view text, const std::string& file, std::vector<BoardProblem>& problems,
                   const BoardContext& context) -> std::optional<decltype(std::declval<Reader&>().read())> {
  const std::size_t before = problems.size();
  const std::optional<toml::table> top = parse_board(text, file, problems);
  if (!top) return std::nullopt;
  auto spec = Reader(*top, file, problems, context).read();
  if (problems.size() != before) return std::nullopt;
  return spec;
}

}  // namespace omnihil::mcu
