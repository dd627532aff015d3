// Collects samples of topics into series, in the order in which the topics first come.
//
//   TopicSeries topics;
//   topics.add("/drive.velocity", 1'500'000'000, 3.2);
//   LogTable log = topics.table(LogFormat::kMcap);              // times in s from the earliest sample on
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "hil/logs/log_table.h"

namespace omnihil {

class TopicSeries {
 public:
  // `unit`: of the first sample of a name counts. A time before 0 is none: such samples are counted.
  void add(const std::string& name, std::int64_t time_ns, double value, const std::string& unit = "");
  LogTable table(LogFormat format) const;  // fields of one topic that always come together share their clock

 private:
  struct Samples {
    std::string name, unit;
    std::vector<std::int64_t> time_ns;
    std::vector<double> value;
  };
  std::vector<Samples> samples_;
  std::map<std::string, std::size_t, std::less<>> index_;
  std::size_t untimed_ = 0;
};

// -1: beyond what 64 bits hold in ns.
constexpr std::int64_t ns_of_us(std::uint64_t time_us) {
  constexpr std::uint64_t kMost = 9'000'000'000'000'000;  // 285 years
  return time_us > kMost ? -1 : static_cast<std::int64_t>(time_us) * 1000;
}

}  // namespace omnihil
