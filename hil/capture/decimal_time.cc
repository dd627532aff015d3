#include "hil/capture/decimal_time.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>

namespace omnihil {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

// 1 to 12 by the first letters of English, German and French names; 0: no month.
int month_of(const std::string& word) {
  static constexpr const char* kNames[] = {
      "jan",      "feb fév fev f\xe9v", "mar mär mrz m\xe4r", "apr avr", "mai may",
      "jun juin", "jul juil",           "aug aoû aou ao\xfb", "sep",     "oct okt",
      "nov",      "dec dez déc d\xe9"};  // also in Latin-1
  for (int month = 1; month <= 12; ++month)
    for (const std::string_view start : words_of(kNames[month - 1]))
      if (word.starts_with(start)) return month;
  return 0;
}

// "17.11.2021", "2021-11-17": three numbers; -1 where it is none.
std::array<int, 3> three_numbers(std::string_view word) {
  std::array<int, 3> numbers{-1, -1, -1};
  std::size_t at = 0;
  for (int& number : numbers) {
    const std::size_t from = at;
    for (number = 0; at < word.size() && is_digit(word[at]) && at - from < 4; ++at)
      number = number * 10 + (word[at] - '0');
    if (at == from) return {-1, -1, -1};
    if (&number != &numbers.back() && (at == word.size() || (word[at] != '.' && word[at] != '-')))
      return {-1, -1, -1};
    ++at;
  }
  return at - 1 == word.size() ? numbers : std::array<int, 3>{-1, -1, -1};
}

struct DateParts {
  int year = -1, month = 0, day = -1;
  std::int64_t of_day_ns = -1;
  int half = 0;  // 1: am, 2: pm
};

// "03:01:42.342"
bool parse_clock(std::string_view word, std::int64_t& ns) {
  const std::size_t first = word.find(':'), second = word.find(':', first + 1);
  std::int64_t hours = 0, minutes = 0, seconds = 0;
  if (first == std::string_view::npos || second == std::string_view::npos) return false;
  if (!parse_decimal_time(word.substr(0, first), 1, hours) ||
      !parse_decimal_time(word.substr(first + 1, second - first - 1), 1, minutes) ||
      !parse_decimal_time(word.substr(second + 1), kSecond_ns, seconds))
    return false;
  if (hours > 23 || minutes > 59 || seconds > 60 * kSecond_ns) return false;
  ns = (hours * 3600 + minutes * 60) * kSecond_ns + seconds;
  return true;
}

bool take(const std::string& word, DateParts& date) {
  if (word.find(':') != std::string::npos) return parse_clock(word, date.of_day_ns);
  if (word == "am" || word == "vorm." || word == "a.m.") return (date.half = 1) != 0;
  if (word == "pm" || word == "nachm." || word == "p.m.") return (date.half = 2) != 0;
  if (const auto numbers = three_numbers(word); numbers[0] >= 0) {
    const bool year_first = numbers[0] > 31;
    date.year = numbers[year_first ? 0 : 2];
    date.month = numbers[1];
    date.day = numbers[year_first ? 2 : 0];
    return true;
  }
  if (is_digit(word[0])) {
    std::int64_t number = 0;
    std::string_view digits = word;
    if (digits.ends_with('.')) digits.remove_suffix(1);  // "17." in German
    if (!parse_decimal_time(digits, 1, number) || number > 9999) return false;
    (number > 31 ? date.year : date.day) = static_cast<int>(number);
    return true;
  }
  // A weekday may begin like a month ("mar" is Tuesday in French): the last such word counts.
  if (const int month = month_of(word); month > 0) date.month = month;
  return true;
}

}  // namespace

bool parse_decimal_time(std::string_view text, std::int64_t unit_ns, std::int64_t& ns) {
  std::int64_t whole = 0;
  std::size_t at = 0;
  for (; at < text.size() && is_digit(text[at]); ++at) {
    if (whole > kMostTime_ns / unit_ns / 10) return false;
    whole = whole * 10 + (text[at] - '0');
    if (whole > kMostTime_ns / unit_ns) return false;
  }
  const std::size_t digits = at;
  std::int64_t part = 0, weight = unit_ns;
  if (at < text.size() && (text[at] == '.' || text[at] == ',')) {
    for (++at; at < text.size() && is_digit(text[at]); ++at) {
      weight /= 10;
      part += weight * (text[at] - '0');
    }
  }
  if (digits == 0 || at != text.size()) return false;
  ns = whole * unit_ns + part;
  return ns <= kMostTime_ns;
}

std::string decimal_time(std::int64_t ns, int decimals) {
  std::int64_t part = ns % kSecond_ns;
  for (int i = decimals; i < 9; ++i) part /= 10;
  return fmt::format("{}.{:0{}}", ns / kSecond_ns, part, decimals);
}

bool parse_date_line(std::string_view text, std::int64_t& unix_ns) {
  DateParts date;
  for (const std::string_view word : words_of(text))
    if (!take(lower_case(word), date)) return false;
  const std::chrono::year_month_day day{std::chrono::year(date.year),
                                        std::chrono::month(static_cast<unsigned>(date.month)),
                                        std::chrono::day(static_cast<unsigned>(date.day))};
  if (date.year < 1970 || date.year > 2096 || date.of_day_ns < 0 || !day.ok()) return false;
  const std::int64_t hour = 3600 * kSecond_ns;
  if (date.half != 0 && date.of_day_ns >= 13 * hour) date.half = 0;  // 24 hours all the same
  if (date.half == 1 && date.of_day_ns >= 12 * hour) date.of_day_ns -= 12 * hour;
  if (date.half == 2 && date.of_day_ns < 12 * hour) date.of_day_ns += 12 * hour;
  unix_ns = std::chrono::sys_days(day).time_since_epoch().count() * 24 * hour + date.of_day_ns;
  return unix_ns <= kMostTime_ns;
}

std::string date_line(std::int64_t unix_ns) {
  static constexpr const char* kDays[] = {"Sun", "Mon", "Tue", "Wed", "Thu", "Fri", "Sat"};
  static constexpr const char* kMonths[] = {"Jan", "Feb", "Mar", "Apr", "May", "Jun",
                                            "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};
  const std::int64_t day_ns = 24 * 3600 * kSecond_ns;
  const std::chrono::sys_days days{std::chrono::days(unix_ns / day_ns)};
  const std::chrono::year_month_day date(days);
  const std::int64_t ms = unix_ns % day_ns / kMillisecond_ns, hour = ms / 3'600'000;
  return fmt::format("{} {} {} {:02}:{:02}:{:02}.{:03} {} {}", kDays[std::chrono::weekday(days).c_encoding()],
                     kMonths[static_cast<unsigned>(date.month()) - 1], static_cast<unsigned>(date.day()),
                     hour % 12 == 0 ? 12 : hour % 12, ms / 60'000 % 60, ms / 1000 % 60, ms % 1000,
                     hour < 12 ? "am" : "pm", static_cast<int>(date.year()));
}

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  constexpr std::string_view kBlanks = " \t\r";
  for (std::size_t at = line.find_first_not_of(kBlanks); at != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(kBlanks, at), line.size());
    words.push_back(line.substr(at, end - at));
    at = line.find_first_not_of(kBlanks, end);
  }
  return words;
}

std::string lower_case(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return out;
}

}  // namespace omnihil
