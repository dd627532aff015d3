// Messages of a bag, whatever it is kept in, as series: what MCAP and rosbag2's SQLite have in common.
//
//   BagTopics bag("run.mcap");
//   bag.define(1, "/joint_states", "cdr", "sensor_msgs/msg/JointState", definition);
//   bag.add(1, log_time_ns, bytes);
//   LogTable log = bag.table(LogFormat::kMcap);
//
// A message whose header has a stamp within kMostApart of the bag's own time is taken at that stamp: when it was
// measured. Encodings: CDR with a definition in ROS's own language, JSON (numbers of any depth). Others are left out
// and counted, by topic.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "hil/logs/ros_message.h"
#include "hil/logs/topic_series.h"

namespace omnihil {

class BagTopics {
 public:
  explicit BagTopics(std::string path) : path_(std::move(path)) {}

  // `definition`: text; empty: one that every ROS 2 has, where it is known.
  void define(std::uint64_t id, const std::string& topic, const std::string& encoding,
              const std::string& type, std::string_view definition);
  void add(std::uint64_t id, std::int64_t log_time_ns, std::string_view bytes);
  LogTable table(LogFormat format) const;  // throws BadLog where there is no number

 private:
  struct Topic {
    std::string name, type, why_not;  // why its messages are left out
    bool json = false;
    std::optional<RosType> ros;
    std::size_t left_out = 0, stamped = 0;
  };
  static constexpr std::int64_t kMostApart_ns = 1'000'000'000;  // a choice: more is another clock

  std::string path_;
  std::map<std::uint64_t, Topic> topics_;
  TopicSeries series_;
  std::size_t unknown_ = 0;
};

}  // namespace omnihil
