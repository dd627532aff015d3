// Lines and words of captures that are text.
//
//   for_each_line(text, notes, [&](std::string_view line, std::size_t number, bool is_cut) { … });
//   parse_hex_number("7E0", id);
#pragma once
#include <charconv>
#include <cstdint>
#include <functional>
#include <string_view>

#include "hil/capture/captured.h"

namespace omnihil {

using LineTaker = std::function<void(std::string_view line, std::size_t number, bool is_cut)>;

// Lines end with LF or CR LF (which is said); a byte order mark is left out. `is_cut`: the file ends inside this line.
inline void for_each_line(std::string_view text, CaptureNotes& notes, const LineTaker& take) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = text.find('\n');
    const bool is_cut = end == std::string_view::npos;
    std::string_view line = text.substr(0, end);
    text.remove_prefix(is_cut ? text.size() : end + 1);
    if (line.ends_with('\r')) {
      line.remove_suffix(1);
      notes.say("lines end with CR LF");
    }
    take(line, number, is_cut);
  }
}

template <class Unsigned>
bool parse_number_of_base(std::string_view text, int base, Unsigned& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, base);
  return !text.empty() && error == std::errc{} && end == text.data() + text.size();
}
inline bool parse_hex_number(std::string_view text, std::uint32_t& value) {
  return parse_number_of_base(text, 16, value);
}

}  // namespace omnihil
