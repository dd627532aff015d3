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
  // `unit`: of the first sample of a name counts.
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
};

}  // namespace omnihil
