#include "hil/tap/tap_vision.h"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <cinttypes>
#include <system_error>
#include <utility>

#include "hil/league/robot_sights.h"

namespace omnihil {

TapVision::File TapVision::open(const std::filesystem::path& path, const char* mode) {
  File file(std::fopen(path.c_str(), mode));
  if (!file) throw std::system_error(errno, std::generic_category(), path.string());
  return file;
}

TapVision::TapVision(UdpPort group, const std::filesystem::path& path)
    : group_(std::move(group)), path_(path), part_(path) {
  part_ += ".part";
  raw_ = open(part_, "wx");
}

TapVision::~TapVision() = default;

void TapVision::pass(std::int64_t now_ns) {
  const double now_s = 1e-9 * static_cast<double>(now_ns);
  std::string datagram;
  sockaddr_in from{};
  while (group_.receive(datagram, from)) {
    const std::optional<FrameTimes> times = frame_times(datagram);
    if (!times) continue;
    ++frames_;
    cameras_[times->camera].add(times->sent_s, now_s);
    for (const Team team : {Team::kBlue, Team::kYellow}) {
      for (const RobotSight& s : robot_sights(datagram, team, std::nullopt)) {
        const std::string row =
            fmt::format("{} {:.9f} {} {} {:.6f} {:.6f} {:.6f} {:.6f}\n", s.camera, s.capture_s,
                        team == Team::kBlue ? "blue" : "yellow", s.robot_id, s.x_m, s.y_m, s.yaw_rad, now_s);
        if (std::fwrite(row.data(), 1, row.size(), raw_.get()) != row.size())
          throw std::system_error(errno, std::generic_category(), part_.string());
      }
    }
  }
}

std::string TapVision::finish(double unix_start_s) {
  raw_.reset();
  std::map<unsigned, ClockFit> fits;
  for (const auto& [camera, line] : cameras_) fits[camera] = line.fit();
  std::filesystem::path making = path_;
  making += ".making";
  {
    const File raw = open(part_, "r");
    const File out = open(making, "w");
    std::fputs("time_s,camera,team,robot,x_m,y_m,yaw_rad,arrived_s\n", out.get());
    unsigned camera = 0;
    int robot = 0;
    double capture_s = 0.0, x_m = 0.0, y_m = 0.0, yaw_rad = 0.0, arrived_s = 0.0;
    std::array<char, 8> team{};
    while (std::fscanf(raw.get(), "%u %lf %7s %d %lf %lf %lf %lf", &camera, &capture_s, team.data(), &robot,
                       &x_m, &y_m, &yaw_rad, &arrived_s) == 8) {
      fmt::print(out.get(), "{:.6f},{},{},{},{:.6f},{:.6f},{:.6f},{:.6f}\n", fits[camera].ours(capture_s),
                 camera, team.data(), robot, x_m, y_m, yaw_rad, arrived_s);
    }
    if (std::fflush(out.get()) != 0) throw std::system_error(errno, std::generic_category(), making.string());
  }
  std::filesystem::rename(making, path_);
  std::filesystem::remove(part_);
  return clock_words(cameras_, unix_start_s);
}

}  // namespace omnihil
