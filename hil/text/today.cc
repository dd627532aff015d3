#include "hil/text/today.h"

#include <charconv>
#include <cstdlib>
#include <cstring>
#include <ctime>

namespace omnihil {

std::string today_utc() {
  std::time_t now = std::time(nullptr);
  if (const char* set = std::getenv("SOURCE_DATE_EPOCH"); set != nullptr) {
    const char* end = set + std::strlen(set);
    std::int64_t seconds = 0;
    const auto [at, error] = std::from_chars(set, end, seconds);
    if (error == std::errc() && at == end) now = static_cast<std::time_t>(seconds);
  }
  std::tm parts{};
  gmtime_r(&now, &parts);
  char text[16];
  return {text, std::strftime(text, sizeof text, "%Y-%m-%d", &parts)};
}

}  // namespace omnihil
