#include "hil/game_log/vision_csv.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "hil/capture/decimal_time.h"
#include "hil/league/messages/ssl_vision.pb.h"

namespace omnihil {
namespace {

using league::SSL_DetectionFrame;
constexpr double kMetre_mm = 1000.0;

bool may_be_vision(GameLogKind kind) {
  return kind == GameLogKind::kVision2010 || kind == GameLogKind::kVision2014 ||
         kind == GameLogKind::kUnknown;
}

class VisionRows {
 public:
  explicit VisionRows(VisionCsv& csv) : csv_(csv) {
    csv.text = "time_s,received_s,camera,frame,object,id,x_m,y_m,yaw_rad,confidence\n";
  }

  // False: a row of it was left out.
  bool add(const SSL_DetectionFrame& frame, std::int64_t received_ns) {
    if (!std::isfinite(frame.t_capture()) || received_ns < 0) return false;
    bool all = true;
    const std::string begin = fmt::format("{:.6f},{},{},{},", frame.t_capture(), decimal_time(received_ns, 9),
                                          frame.camera_id(), frame.frame_number());
    const auto add_robots = [&](const auto& robots, const char* team) {
      for (const auto& robot : robots) {
        const std::string id = robot.has_robot_id() ? std::to_string(robot.robot_id()) : "";
        const bool is_finite = std::isfinite(robot.orientation());
        const std::string yaw = robot.has_orientation() ? fmt::format("{:.6f}", robot.orientation()) : "";
        const bool added = is_finite && row(begin, team, id, robot, yaw);
        csv_.robots += added ? 1 : 0;
        all = all && added;
      }
    };
    add_robots(frame.robots_yellow(), "yellow");
    add_robots(frame.robots_blue(), "blue");
    for (const auto& ball : frame.balls()) {
      const bool added = row(begin, "ball", "", ball, "");
      csv_.balls += added ? 1 : 0;
      all = all && added;
    }
    ++csv_.frames;
    return all;
  }

 private:
  template <class Seen>
  bool row(const std::string& begin, const char* object, const std::string& id, const Seen& seen,
           const std::string& yaw) {
    if (!std::isfinite(seen.x()) || !std::isfinite(seen.y()) || !std::isfinite(seen.confidence()))
      return false;
    fmt::format_to(std::back_inserter(csv_.text), "{}{},{},{:.6f},{:.6f},{},{:.4f}\n", begin, object, id,
                   seen.x() / kMetre_mm, seen.y() / kMetre_mm, yaw, seen.confidence());
    return true;
  }

  VisionCsv& csv_;
};

}  // namespace

VisionCsv vision_csv(GameLogReader& log) {
  VisionCsv csv;
  VisionRows rows(csv);
  GameLogRecord record;
  league::SSL_WrapperPacket packet;
  while (log.next(record)) {
    if (!may_be_vision(record.kind)) {
      ++csv.other_records;
      continue;
    }
    // Of 2010 the geometry has other fields, and lacks some: the detection alone must be whole.
    const bool is_read = packet.ParsePartialFromString(record.bytes);
    const bool has_frame = is_read && packet.has_detection();
    if (!is_read || (has_frame && !packet.detection().IsInitialized())) {
      if (record.kind == GameLogKind::kUnknown)
        ++csv.other_records;
      else
        log.more_notes().count("a message of vision that cannot be read: left out", log.records());
    } else if (!has_frame) {
      ++csv.other_records;  // geometry alone
    } else if (!rows.add(packet.detection(), record.received_ns)) {
      log.more_notes().count("a time or position that is no number: left out", log.records());
    }
  }
  return csv;
}

}  // namespace omnihil
