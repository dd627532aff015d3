#include "firmware_iface/mcu/board/wheel_commands_reader.h"

#include <fmt/format.h>

#include "firmware_iface/mcu/board/wheel_words_reader.h"

namespace omnihil::mcu {
namespace {

constexpr std::string_view kPath = "wheel_commands";
constexpr const char* kFormat = "omnihil-dialect/1";

Dialect read_named(const toml::table& t, BoardKeys& keys, int motors, const FindDialect& find) {
  const auto name = keys.text(t, std::string(kPath), "dialect");
  const DialectFile file = find ? find(name.value_or("")) : DialectFile{.error = "there are none"};
  if (!t.contains("dialect")) {
    keys.missing(t, std::string(kPath), "dialect",
                 file.allowed + ", or [[wheel_commands.frame]] and period_ms");
  } else if (name && !file.error.empty()) {
    keys.wrong(t, std::string(kPath), "dialect", file.error, file.allowed);
  } else if (name) {
    return read_dialect(file, motors, keys.problems()).value_or(Dialect{});
  }
  return {};
}

}  // namespace

std::optional<Dialect> read_dialect(const DialectFile& file, int motors,
                                    std::vector<BoardProblem>& problems) {
  const std::size_t before = problems.size();
  const auto top = parse_board(file.text, file.path, problems);
  if (!top) return std::nullopt;
  BoardKeys keys(file.path, problems);
  keys.only(*top, "", {"format", "name", "source", "port", "period_ms", "frame"});
  keys.format(*top, kFormat);
  for (const std::string_view key : {"name", "source"}) keys.text(*top, "", key);
  if (!top->contains("name")) keys.missing(*top, "", "name", "a text");
  const auto port = keys.word(*top, "", "port", {"serial", "can"}, true);
  Dialect dialect{.words = {}, .serial = port == 0u};
  dialect.words = read_wheel_words(*top, "", keys, dialect.serial, motors);
  if (dialect.words.frames.empty() && !top->contains("frame"))
    keys.missing(*top, "", "frame", "[[frame]], what is said");
  if (problems.size() != before) return std::nullopt;
  return dialect;
}

WheelCommands read_wheel_commands(const toml::table& top, BoardKeys& keys, const BoardNames* names,
                                  const CommandedBoard& board, const FindDialect& find) {
  WheelCommands commands;
  const std::string path(kPath);
  const toml::node* node = top.get(kPath);
  if (node == nullptr) return commands;
  const toml::table* t = node->as_table();
  if (t == nullptr) {
    keys.wrong(top, "", kPath, "not a table", "[wheel_commands]");
    return commands;
  }
  if (top.contains("radio")) keys.wrong(top, "", kPath, "beside [radio]", "one of the two");
  keys.only(*t, path, {"dialect", "via", "reversed", "period_ms", "frame"});
  const bool own = t->contains("frame");
  commands.via = keys.text(*t, path, "via").value_or("");
  commands.sign = keys.flag(*t, path, "reversed").value_or(false) ? -1.0 : 1.0;
  const bool is_can = names != nullptr && names->has_can(commands.via),
             is_serial = names != nullptr && names->has_serial(commands.via);
  const auto no_port = [&](const std::string& what, const std::string& allowed) {
    keys.wrong(*t, path, "via", t->contains("via") ? what : "missing", allowed);
  };
  if (own) {
    if (t->contains("dialect")) keys.wrong(*t, path, "dialect", "beside frames", "one of the two");
    commands.serial = is_serial;
    commands.words = read_wheel_words(*t, path, keys, is_serial, board.motors);
    if (names != nullptr && !is_can && !is_serial)
      no_port("no such port", names->serials() + ", " + names->cans());
  } else {
    if (t->contains("period_ms"))
      keys.wrong(*t, path, "period_ms", "beside a dialect", "the dialect has its own");
    const Dialect dialect = read_named(*t, keys, board.motors, find);
    commands.words = dialect.words;
    commands.serial = dialect.serial;
    if (names != nullptr && dialect.words.period_ns != 0 && !(dialect.serial ? is_serial : is_can))
      no_port(dialect.serial ? "not a serial port of the chip" : "not a CAN of the chip",
              dialect.serial ? names->serials() : names->cans());
  }
  if (commands.words.period_ns % board.coupling_ns != 0)
    keys.wrong(*t, path, own ? "period_ms" : "dialect", "its period is no multiple of coupling_us",
               fmt::format("{} us times a number", board.coupling_ns / 1000));
  return commands;
}

}  // namespace omnihil::mcu
