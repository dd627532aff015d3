#include "hil/observe/vcd_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <iterator>
#include <map>

namespace omnihil {
namespace {

// Of the printable characters, as short as can be.
std::string code_of(int signal) {
  constexpr int kFirst = '!', kMany = '~' - '!' + 1;
  std::string code;
  for (int rest = signal; code.empty() || rest > 0; rest /= kMany)
    code += static_cast<char>(kFirst + rest % kMany);
  return code;
}

std::string_view word_of(WaveKind kind) {
  constexpr std::string_view kWords[] = {"wire", "reg", "integer", "real"};
  return kWords[static_cast<std::size_t>(kind)];
}

void append_value(std::string& out, const WaveSignal& signal, WaveValue value, const std::string& code) {
  if (signal.kind == WaveKind::kLevel) {
    out += value.none ? 'z' : value.raw != 0 ? '1' : '0';
  } else if (signal.kind == WaveKind::kReal) {
    fmt::format_to(std::back_inserter(out), "r{:.9g} ", value.none ? 0.0 : std::bit_cast<double>(value.raw));
  } else if (value.none) {
    out += "bz ";
  } else {
    const std::uint64_t mask = signal.bits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << signal.bits) - 1;
    fmt::format_to(std::back_inserter(out), "b{:b} ", value.raw & mask);
  }
  out += code;
  out += '\n';
}

// "robot0.board1": a module within a module.
void append_scope(std::string& out, const std::string& scope, const char* line) {
  std::size_t depth = 1 + static_cast<std::size_t>(std::ranges::count(scope, '.'));
  for (std::size_t from = 0; depth > 0; --depth) {
    const std::size_t dot = std::min(scope.find('.', from), scope.size());
    fmt::format_to(std::back_inserter(out), fmt::runtime(line), scope.substr(from, dot - from));
    from = dot + 1;
  }
}

}  // namespace

std::string vcd_text(const WaveLog& log) {
  const std::vector<WaveSignal>& signals = log.signals();
  std::map<std::string, std::vector<int>> scopes;
  for (std::size_t s = 0; s < signals.size(); ++s)
    if (signals[s].shown) scopes[signals[s].scope].push_back(static_cast<int>(s));
  std::string out = "$version omnihil $end\n$timescale 1 ns $end\n";
  for (const auto& [scope, of] : scopes) {
    append_scope(out, scope, "$scope module {} $end\n");
    std::string before = scopes.size() > 1 ? scope + "_" : "";
    std::ranges::replace(before, '.', '_');
    for (const int s : of) {
      const WaveSignal& signal = signals[static_cast<std::size_t>(s)];
      fmt::format_to(std::back_inserter(out), "$var {} {} {} {}{} $end\n", word_of(signal.kind), signal.bits,
                     code_of(s), before, signal.name);
    }
    append_scope(out, scope, "$upscope $end\n");
  }
  const std::int64_t from_ns = log.from_ns();
  std::vector<WaveValue> at_first(signals.size());
  for (std::size_t s = 0; s < signals.size(); ++s) at_first[s] = signals[s].first;
  std::vector<WaveEvent> events;
  for (const WaveEvent& event : log.events()) {
    if (event.at_ns <= from_ns) {
      at_first[static_cast<std::size_t>(event.signal)] = event.value;
    } else {
      events.push_back(event);
    }
  }
  std::ranges::stable_sort(events, {}, &WaveEvent::at_ns);
  fmt::format_to(std::back_inserter(out), "$enddefinitions $end\n#{}\n$dumpvars\n", from_ns);
  for (const auto& [scope, of] : scopes) {
    for (const int s : of) {
      const auto i = static_cast<std::size_t>(s);
      append_value(out, signals[i], at_first[i], code_of(s));
    }
  }
  out += "$end\n";
  std::int64_t now_ns = from_ns;
  for (const WaveEvent& event : events) {
    if (event.at_ns != now_ns) fmt::format_to(std::back_inserter(out), "#{}\n", event.at_ns);
    now_ns = event.at_ns;
    append_value(out, signals[static_cast<std::size_t>(event.signal)], event.value, code_of(event.signal));
  }
  if (log.to_ns() > now_ns) fmt::format_to(std::back_inserter(out), "#{}\n", log.to_ns());
  return out;
}

}  // namespace omnihil
