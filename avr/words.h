// A line of the conversation, word by word. Anything unexpected is a BadLine, with what was expected.
//
//   Words words("run 500000 0x1p+3");
//   words.text();  words.integer();  words.real();  words.end();
#pragma once
#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace omnihil_avr {

struct BadLine : std::runtime_error {
  using std::runtime_error::runtime_error;
};

class Words {
 public:
  explicit Words(const std::string& line) : line_(line), in_(line) {}
  std::string text() {
    std::string word;
    if (!(in_ >> word)) fail("a further word");
    return word;
  }
  std::int64_t integer() {
    const std::string word = text();
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{} || end != word.data() + word.size()) fail("a whole number, not " + word);
    return value;
  }
  std::uint32_t address() {
    const std::int64_t value = integer();
    if (value < 0 || value > 0xFFFFFFFF) fail("an address, not " + std::to_string(value));
    return static_cast<std::uint32_t>(value);
  }
  double real() {
    const std::string word = text();
    char* end = nullptr;
    const double value = std::strtod(word.c_str(), &end);
    if (*end != 0) fail("a number, not " + word);
    return value;
  }
  std::vector<std::uint8_t> bytes() {
    const std::string word = text();
    std::vector<std::uint8_t> result;
    for (std::size_t i = 0; i + 1 < word.size(); i += 2) {
      std::uint8_t value = 0;
      const auto [end, error] = std::from_chars(&word[i], &word[i] + 2, value, 16);
      if (error != std::errc{} || end != &word[i] + 2) fail("bytes in hexadecimal");
      result.push_back(value);
    }
    if (word.size() % 2 != 0) fail("bytes in hexadecimal, two digits each");
    return result;
  }
  bool more() { return !(in_ >> std::ws).eof(); }
  void end() {
    std::string word;
    if (in_ >> word) fail("nothing more, not " + word);
  }
  [[noreturn]] void fail(const std::string& expected) const {
    throw BadLine("\"" + line_.substr(0, 60) + "\": expected " + expected);
  }

 private:
  std::string line_;
  std::istringstream in_;
};

}  // namespace omnihil_avr
