#include "hil/check/firmware_alone.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "firmware_iface/forwarded_firmware.h"
#include "hil/loop/reference_firmware.h"
#include "hil/recording/recorded_samples.h"

namespace omnihil {
namespace {

// Where a robot's sensors and shafts stand among the columns.
struct SensorColumns {
  std::array<std::size_t, kWheels> encoder{}, current{}, theta{}, omega{};
  std::size_t bus = 0, gyro = 0, accel_x = 0, accel_y = 0;

  static std::optional<SensorColumns> of(const RecordingHeader& header) {
    bool complete = true;
    const auto place = [&](const std::string& name) {
      const std::size_t at = column_place(header, name);
      complete = complete && at < header.columns.size();
      return at;
    };
    SensorColumns c;
    for (std::size_t w = 0; w < kWheels; ++w) {
      const std::string number = "_" + std::to_string(w + 1);
      c.encoder[w] = place("encoder_counts" + number);
      c.current[w] = place("motor_current_A" + number);
      c.theta[w] = place("true_theta_rotor_rad" + number);
      c.omega[w] = place("true_omega_rotor_rad_s" + number);
    }
    c.bus = place("bus_voltage_V");
    c.gyro = place("gyro_z_rad_s");
    c.accel_x = place("accel_x_m_s2");
    c.accel_y = place("accel_y_m_s2");
    if (!complete) return std::nullopt;
    return c;
  }
};

using Ticks = std::vector<const RecordedChunk*>;

// Hands everything on but the sensors, which are those of the recording, tick by tick.
class FedFirmware final : public ForwardedFirmware {
 public:
  FedFirmware(std::unique_ptr<Firmware> inner, const SensorColumns& columns, Ticks ticks)
      : ForwardedFirmware(std::move(inner)), columns_(columns), ticks_(std::move(ticks)) {}

  void shafts(const RobotShafts& simulated) override {
    RobotShafts fed = simulated;
    if (const RecordedChunk* tick = at()) {
      for (std::size_t w = 0; w < kWheels; ++w) {
        fed.theta_rotor_rad[w] = tick->sample[columns_.theta[w]];
        fed.omega_rotor_rad_s[w] = tick->sample[columns_.omega[w]];
      }
    }
    inner().shafts(fed);
  }
  RobotDrive tick(const RobotSensors& simulated) override {
    RobotSensors fed = simulated;
    if (const RecordedChunk* tick = at()) {
      const std::vector<double>& s = tick->sample;
      for (std::size_t w = 0; w < kWheels; ++w) {
        fed.encoder_counts[w] = static_cast<decltype(fed.encoder_counts[w] + 0)>(s[columns_.encoder[w]]);
        fed.motor_current_A[w] = s[columns_.current[w]];
      }
      fed.bus_voltage_V = s[columns_.bus];
      fed.gyro_z_rad_s = s[columns_.gyro];
      fed.accel_x_m_s2 = s[columns_.accel_x];
      fed.accel_y_m_s2 = s[columns_.accel_y];
    }
    ++next_;
    return inner().tick(fed);
  }

 private:
  const RecordedChunk* at() const { return next_ < ticks_.size() ? ticks_[next_] : nullptr; }

  SensorColumns columns_;
  Ticks ticks_;
  std::size_t next_ = 0;
};

std::map<std::uint32_t, Ticks> ticks_by_robot(const Recording& recording) {
  std::map<std::uint32_t, Ticks> ticks;
  for (const RecordedChunk& chunk : recording.chunks) {
    if (chunk.kind == RecordedChunk::Kind::kSample)
      ticks[static_cast<std::uint32_t>(chunk.robot_id)].push_back(&chunk);
  }
  return ticks;
}

}  // namespace

FirmwareAlone run_firmware_alone(const Recording& recording, const ReplayOptions& options) {
  FirmwareAlone out;
  const auto columns = SensorColumns::of(recording.header);
  const std::map<std::uint32_t, Ticks> ticks = ticks_by_robot(recording);
  if (!columns || ticks.empty()) {
    out.why_not = "the recording has no samples of the sensors";
  } else if (recording.header.sample_every != 1) {
    out.why_not = fmt::format("only every {}th tick is recorded (serve --sample-every 1 records all)",
                              recording.header.sample_every);
  }
  if (!out.why_not.empty()) return out;
  bool phases = false;
  ReplayOptions fed = options;
  fed.observer = nullptr;
  const auto feed = [&](Session::FirmwareMaker make, std::uint32_t first_key) -> Session::FirmwareMaker {
    return [&, make, first_key](const RobotConfig& robot) -> std::unique_ptr<Firmware> {
      std::unique_ptr<Firmware> inner = make(robot);
      phases = phases || inner->drives_phases();
      const auto found = ticks.find(first_key + robot.robot_id);
      return std::make_unique<FedFirmware>(std::move(inner), *columns,
                                           found == ticks.end() ? Ticks{} : found->second);
    };
  };
  fed.firmware = [&](const SessionConfig& config) {
    return feed(options.firmware ? options.firmware(config) : reference_firmware_for(config), 0);
  };
  fed.opponents_firmware = [&](const SessionConfig& alone) {
    const auto& own = options.opponents_firmware ? options.opponents_firmware : options.firmware;
    return feed(own ? own(alone) : reference_firmware_for(alone), kOpponentKey);
  };
  ReplayRun run = run_again(recording, fed);
  if (phases) {
    out.why_not = "the firmware drives the phases of its motors, which are not recorded";
    return out;
  }
  if (!run.firmware_failure.empty()) out.why_not = run.firmware_failure;
  out.answer = std::move(run.answer);
  return out;
}

}  // namespace omnihil
