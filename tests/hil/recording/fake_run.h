// A made-up run for tests of recordings: every value of every sample differs, none is round.
#pragma once
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "hil/recording/recording.h"
#include "hil/recording/recording_writer.h"

namespace omnihil::fake {

inline RecordingHeader header(std::vector<int> ids = {0, 3}, int sample_every = 1) {
  RecordingHeader header;
  header.commit = "abc1234";
  header.robot_model = "made-up";
  header.robot_model_text = "name = \"made \\ up\"\n# \"quoted\", ünïcode\n";
  header.included_models = {{"motors/m.toml", "resistance_ohm = 0.5\n"}};
  header.radio_format = "ulaval-hermes";
  header.firmware = "reference";
  header.robot_ids = std::move(ids);
  header.team = Team::kYellow;
  header.plant.physics = Physics::kPlanar;
  header.plant.seed = 18446744073709551615ULL;
  header.step_ns = 1'000'000;
  header.epoch_ms = 1'700'000'000'123;
  header.seed = 18446744073709551615ULL;
  header.started = "2026-01-02T03:04:05Z";
  header.sample_every = sample_every;
  return header;
}

// Fields of quantity q and wheel w at tick n: an irrational number of its own.
inline double value(int id, int n, int q, int w) {
  return std::sin(1.0 + id + 0.1 * n + 10.0 * q + 100.0 * w) / 3.0;
}

inline RobotSample sample(int id, int n) {
  RobotSample s;
  s.robot_id = id;
  for (int w = 0; w < kWheels; ++w) {
    const auto i = static_cast<std::size_t>(w);
    s.drive.duty_ratio[w] = value(id, n, 0, w);
    s.drive.mode[w] = OMNIHIL_DRIVE_DUTY;
    s.sensors.encoder_counts[w] = 1'000'000'007LL * n - 17 * w;
    s.sensors.motor_current_A[w] = value(id, n, 1, w);
    s.feedback.omega_wheel_rad_s[w] = value(id, n, 2, w);
    s.truth.theta_rotor_rad[i] = value(id, n, 3, w) * 1e6;
    s.truth.omega_rotor_rad_s[i] = value(id, n, 4, w);
    s.truth.slip_longitudinal_ratio[i] = value(id, n, 5, w) * 1e-12;
    s.truth.load_N[i] = 6.0 + value(id, n, 6, w);
  }
  s.sensors.bus_voltage_V = 22.2 + value(id, n, 7, 0);
  s.sensors.gyro_z_rad_s = value(id, n, 8, 0);
  s.truth.x_m = 0.001 * n + id;
  s.truth.y_m = -0.0;
  s.truth.yaw_rad = value(id, n, 9, 0);
  s.truth.v_forward_m_s = value(id, n, 10, 0);
  return s;
}

// Host bytes at 0 ms and 5 ms, dongle bytes at 6 ms, a close at 8 ms, a sample per robot and millisecond.
inline void run(SessionObserver& observer, const std::vector<int>& ids, int milliseconds) {
  const std::uint8_t command[] = {0x03, 0xff, 0x00};
  const std::uint8_t answer[] = {0x80, 0x01, 0x7f, 0x00};
  for (int n = 0; n < milliseconds; ++n) {
    const std::int64_t now_ns = 1'000'000LL * n;
    if (n == 0 || n == 5) observer.host_bytes(now_ns, command);
    if (n == 6) observer.dongle_bytes(now_ns, answer);
    if (n == 8) observer.host_closed(now_ns);
    for (const int id : ids) observer.robot_tick(now_ns, sample(id, n));
  }
}

// A folder of its own that goes away with the test.
class TempFolder {
 public:
  TempFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "omnihil-test-XXXXXX").string();
    path_ = ::mkdtemp(name.data());
  }
  ~TempFolder() { std::filesystem::remove_all(path_); }
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

inline std::string read_text(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline void write_text(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

}  // namespace omnihil::fake
