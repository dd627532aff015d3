#include "hil/capture/decimal_time.h"

#include <gtest/gtest.h>

namespace omnihil {
namespace {

std::int64_t parsed(const char* text, std::int64_t unit_ns) {
  std::int64_t ns = -1;
  EXPECT_TRUE(parse_decimal_time(text, unit_ns, ns)) << text;
  return ns;
}

TEST(DecimalTime, IsExactToTheNanosecond) {
  EXPECT_EQ(parsed("1436509052.249713", kSecond_ns), 1'436'509'052'249'713'000);
  EXPECT_EQ(parsed("1436509052.249713001", kSecond_ns), 1'436'509'052'249'713'001);
  EXPECT_EQ(parsed("33.3", kMillisecond_ns), 33'300'000);
  EXPECT_EQ(parsed("33,3", kMillisecond_ns), 33'300'000);
  EXPECT_EQ(parsed("0.1234567891", kSecond_ns), 123'456'789);  // cut, not rounded
  EXPECT_EQ(parsed("12", 1), 12);
  EXPECT_EQ(parsed("12.9", 1), 12);
  EXPECT_EQ(parsed("5.", kSecond_ns), 5 * kSecond_ns);
}

TEST(DecimalTime, RefusesWhatIsNoTimeOrTooLarge) {
  std::int64_t ns = 0;
  for (const char* text : {"", ".", ".5", "-1", "+1", "1e3", "1.2.3", "1 ", " 1", "0x1", "nan", "inf",
                           "4000000001", "99999999999999999999999999"})
    EXPECT_FALSE(parse_decimal_time(text, kSecond_ns, ns)) << text;
  EXPECT_FALSE(parse_decimal_time("40000000000000000000", 1, ns));  // one digit more than 64 bits hold
  EXPECT_FALSE(parse_decimal_time("4000000000000000001", 1, ns));
  EXPECT_TRUE(parse_decimal_time("3999999999.999999999", kSecond_ns, ns));
}

TEST(DecimalTime, IsWrittenWithItsDecimals) {
  EXPECT_EQ(decimal_time(1'436'509'052'249'713'999, 6), "1436509052.249713");
  EXPECT_EQ(decimal_time(1'436'509'052'249'713'999, 9), "1436509052.249713999");
  EXPECT_EQ(decimal_time(5, 6), "0.000000");
  for (const std::int64_t ns : {0LL, 1LL, 999'999'999LL, 1'000'000'000LL, 3'999'999'999'999'999'999LL})
    EXPECT_EQ(parsed(decimal_time(ns, 9).c_str(), kSecond_ns), ns);
}

// 2021-11-17 15:01:42.342 UTC: `date -u -d 2021-11-17T15:01:42 +%s` is 1637161302.
constexpr std::int64_t kAfternoon_ns = 1'637'161'302'342'000'000;

TEST(DateLine, IsReadInThreeLanguagesAndInNumbers) {
  for (const char* text :
       {"Wed Nov 17 03:01:42.342 pm 2021", "Mit Nov 17 03:01:42.342 pm 2021", "Mit Nov 17 15:01:42.342 2021",
        "mer. nov. 17 03:01:42.342 PM 2021", "2021-11-17 15:01:42.342", "17.11.2021 15:01:42.342",
        "Mittwoch 17. November 2021 15:01:42,342", "Wed Nov 17 03:01:42.342 2021 pm"}) {
    std::int64_t ns = 0;
    EXPECT_TRUE(parse_date_line(text, ns)) << text;
    EXPECT_EQ(ns, kAfternoon_ns) << text;
  }
}

TEST(DateLine, TellsMidnightFromNoon) {
  std::int64_t midnight = 0, noon = 0;
  EXPECT_TRUE(parse_date_line("Wed Nov 17 12:00:00.000 am 2021", midnight));
  EXPECT_TRUE(parse_date_line("Wed Nov 17 12:00:00.000 pm 2021", noon));
  EXPECT_EQ(noon - midnight, 12 * 3600 * kSecond_ns);
  EXPECT_EQ(midnight % (24 * 3600 * kSecond_ns), 0);
}

// In every month: names that begin alike (Mar and Mai, Jun and Jul, mardi and mars) are told apart.
TEST(DateLine, OfEveryMonthIsReadAgain) {
  for (int day = 0; day < 365; day += 9) {
    const std::int64_t ns = kAfternoon_ns + day * 24 * 3600 * kSecond_ns;
    std::int64_t read = 0;
    EXPECT_TRUE(parse_date_line(date_line(ns), read)) << date_line(ns);
    EXPECT_EQ(read, ns) << date_line(ns);
  }
  std::int64_t read = 0;
  EXPECT_TRUE(parse_date_line("mar. nov. 16 15:01:42.342 2021", read));  // a Tuesday in November
  EXPECT_EQ(read, kAfternoon_ns - 24 * 3600 * kSecond_ns);
}

TEST(DateLine, RefusesWhatIsNoDate) {
  std::int64_t ns = 0;
  for (const char* text :
       {"", "Wed", "Wed Nov 17 2021", "2021-13-17 15:01:42", "2021-02-30 15:01:42", "Nov 17 25:01:42 2021",
        "Nov 17 15:61:42 2021", "Nov 17 15:01 2021", "Nov 17 15:01:42 1969", "Nov 17 15:01:42 9999",
        "Nov 17 15:01:42 2096", "17.11 15:01:42", "1-2- 15:01:42"})
    EXPECT_FALSE(parse_date_line(text, ns)) << text;
}

}  // namespace
}  // namespace omnihil
