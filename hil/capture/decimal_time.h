// Times of captures as text: exact to the nanosecond, which a double is not at Unix time.
//
//   std::int64_t ns;
//   parse_decimal_time("1436509052.249713", kSecond_ns, ns);      // 1'436'509'052'249'713'000
//   decimal_time(ns, 6);                                          // "1436509052.249713"
//   parse_date_line("Mit Okt 17 03:01:42.342 pm 2021", ns);       // Unix time, read as UTC
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace omnihil {

inline constexpr std::int64_t kSecond_ns = 1'000'000'000, kMillisecond_ns = 1'000'000,
                              kMicrosecond_ns = 1'000;
// In September 2001: a time below counts from the start of something.
inline constexpr std::int64_t kUnixFrom_ns = 1'000'000'000 * kSecond_ns;
// In the year 2096. Larger times are refused: two of them can be added without an overflow.
inline constexpr std::int64_t kMostTime_ns = 4'000'000'000 * kSecond_ns;

// Digits with a point or a comma among them; what is finer than a nanosecond is cut off. False: anything else, or too large.
bool parse_decimal_time(std::string_view text, std::int64_t unit_ns, std::int64_t& ns);
// Seconds with that many decimals; finer parts are cut off.
std::string decimal_time(std::int64_t ns, int decimals);

// A date as CAN tools write it: weekday and month in English, German or French words, or numbers with the year first
// (2021-11-17) or last (17.11.2021); 24 hours, or 12 with am or pm before or after the year. False: not understood.
// Cannot: time zones (none of the tools writes one), 11/17/2021, where the month is first.
bool parse_date_line(std::string_view text, std::int64_t& unix_ns);
// "Wed Nov 17 03:01:42.342 pm 2021", as Vector's tools write it in English; UTC.
std::string date_line(std::int64_t unix_ns);

// Words of a line, parted by blanks and tabs; '\r' is a blank.
std::vector<std::string_view> words_of(std::string_view line);
std::string lower_case(std::string_view text);  // ASCII

}  // namespace omnihil
