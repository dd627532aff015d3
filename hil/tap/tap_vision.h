// The cameras beside a tap: what SSL-Vision says while bytes pass, on the recording's clock.
//
//   TapVision vision(std::move(group), "evening.omnirec.vision.csv");
//   vision.pass(now_ns);                        // as the tap: since the recording began
//   std::cout << vision.finish(unix_start_s);      // the table is there now; offset and drift of each camera
//
// A row per robot and frame: time_s (its capture, brought to the recording's clock by a line under the delays of all
// frames of its camera, hil/loop/clock_line.h), camera, team, robot, x_m, y_m, yaw_rad, arrived_s. The line is known at the end
// only: until then rows stand, by the camera's clock, in FILE.part, which a killed tap leaves behind.
// Throws std::system_error where a file cannot be written.
#pragma once
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "hil/league/udp_port.h"
#include "hil/loop/clock_line.h"

namespace omnihil {

class TapVision {
 public:
  TapVision(UdpPort group, const std::filesystem::path& path);
  ~TapVision();
  TapVision(const TapVision&) = delete;
  TapVision& operator=(const TapVision&) = delete;

  void pass(std::int64_t now_ns);
  std::string finish(double unix_start_s);
  int handle() const { return group_.handle(); }
  std::uint64_t frames() const { return frames_; }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  using File = std::unique_ptr<std::FILE, Close>;
  static File open(const std::filesystem::path& path, const char* mode);

  UdpPort group_;
  std::filesystem::path path_, part_;
  File raw_;
  std::map<unsigned, ClockLine> cameras_;
  std::uint64_t frames_ = 0;
};

}  // namespace omnihil
