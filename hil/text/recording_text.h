// Numbers and bytes of a recording's lines, to text and back, without loss and without a locale.
//
//   append_number(line, 0.1);        // "0.1": the shortest text that gives the same double back
//   append_hex(line, bytes);         // "03ff"
//   parse_hex("03f", bytes);         // false: an odd number of digits
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace omnihil {

void append_number(std::string& text, double value);
void append_integer(std::string& text, std::int64_t value);
void append_hex(std::string& text, std::span<const std::uint8_t> bytes);
std::string to_hex(std::span<const std::uint8_t> bytes);

// The whole of `text` must be the value; a number must be finite. Hex takes digits of either case.
bool parse_number(std::string_view text, double& value);
bool is_no_number(std::string_view text, double& value);  // "nan", "inf", "-inf"
bool parse_integer(std::string_view text, std::int64_t& value);
bool parse_hex(std::string_view text, std::vector<std::uint8_t>& bytes);

// Cuts the next word off `rest`, which words are separated from by exactly one blank. Empty at the end.
std::string_view next_word(std::string_view& rest);

// "'text'" for a message: at most 40 characters, control characters shown as '.'.
std::string in_quotes(std::string_view text);

}  // namespace omnihil
