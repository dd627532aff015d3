#include "tools/options/bench_text.h"

#include <algorithm>
#include <array>
#include <charconv>

#include "tools/options/bench_file.h"

namespace omnihil {
namespace {

// They say what is done with a bench, not what it is.
constexpr std::array<std::string_view, 3> kNotOfIt{"bench", "print-bench", "help"};

bool is_number(const std::string& text) {
  double value = 0.0;
  const char* const end = text.data() + text.size();
  const auto [at, error] = std::from_chars(text.data(), end, value, std::chars_format::fixed);
  const std::size_t digits = text.find_first_not_of('-');
  // As TOML writes one: digits on both sides of a dot, no zero before others.
  const bool plain = digits != std::string::npos && text.back() != '.' && text[digits] != '.' &&
                     (text[digits] != '0' || digits + 1 == text.size() || text[digits + 1] == '.');
  return error == std::errc{} && at == end && plain &&
         text.find_first_not_of("-0123456789.") == std::string::npos;
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

std::string value_of(const std::string& text) { return is_number(text) ? text : quoted(text); }

}  // namespace

std::string bench_text(std::span<const OptionSetting> settings) {
  std::string text = "format = " + quoted(kBenchFormat) + "\n";
  for (const OptionSetting& setting : settings) {
    if (std::ranges::find(kNotOfIt, setting.name) != kNotOfIt.end() || setting.values.empty()) continue;
    std::string key = setting.name == "format" ? "radio_file" : setting.name;
    std::ranges::replace(key, '-', '_');
    text += key + " = ";
    if (setting.is_flag) {
      text += "true";
    } else if (setting.is_list) {
      text += '[';
      for (std::size_t i = 0; i < setting.values.size(); ++i)
        text += (i > 0 ? ", " : "") + quoted(setting.values[i]);
      text += ']';
    } else {
      text += value_of(setting.values.front());
    }
    text += '\n';
  }
  return text;
}

}  // namespace omnihil
