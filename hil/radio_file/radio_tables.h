// What a radio format from a file owns: its texts, rows, rules and packets, and the format made of them.
#pragma once
#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "protocols/radio_format.h"

namespace omnihil {

struct RadioTables {
  std::deque<std::string> texts;  // a deque: views into them stay
  std::deque<std::vector<Field>> rows;
  std::deque<ChecksumRule> sums;
  std::vector<Message> messages;
  std::vector<std::uint8_t> list_begin;
  PacketList list;
  RadioFormat format;

  std::string_view keep(std::string text) { return texts.emplace_back(std::move(text)); }
  // One rule for all fields that have it.
  const ChecksumRule* keep(const ChecksumRule& sum);
};

// The first difference between two formats' packets, as words: "packet master, field robot: bits"; empty: none.
std::string first_difference(const RadioFormat& a, const RadioFormat& b);

}  // namespace omnihil
