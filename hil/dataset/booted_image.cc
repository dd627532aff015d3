#include "hil/dataset/booted_image.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace omnihil {

BootedImage::BootedImage(std::unique_ptr<Firmware> image, const RadioFormat* radio, const RobotConfig& config,
                         double boot_s)
    : image_(std::move(image)) {
  boot_ticks_ = std::llround(1e9 * boot_s / static_cast<double>(image_->control_period_ns()));
  const auto id = static_cast<int>(config.robot_id);
  if (radio == nullptr) return;
  radio_ = std::make_unique<RadioFront>(*radio, id, config.wheel_radius_m);
  ear_ = std::make_unique<RadioEar>(*radio, id);
}

RobotDrive BootedImage::tick(const RobotSensors& sensors) {
  if (ticks_ == 0) boot(sensors);
  // The heading that its telemetry has told, before any that of its start.
  const double told_rad = ear_ ? ear_->told(now_ns()).yaw_rad : 0.0,
               yaw_rad = std::isfinite(told_rad) ? told_rad : 0.0;
  for (const RobotCommand& command : heard_) {
    if (radio_ == nullptr) {
      image_->command(command, now_ns());
    } else if (!radio_->say(command, *image_, now_ns(), yaw_rad) && failure_.empty()) {
      failure_ = "a command cannot be said in its radio format";
    }
  }
  heard_.clear();
  return turn(sensors, exact_);
}

void BootedImage::boot(const RobotSensors& sensors) {
  RobotSensors still = sensors;
  std::fill_n(still.motor_current_A, kWheels, 0.0);
  still.gyro_z_rad_s = still.accel_x_m_s2 = still.accel_y_m_s2 = 0.0;
  RobotShafts standing = exact_;
  std::fill_n(standing.omega_rotor_rad_s, kWheels, 0.0);
  while (ticks_ < boot_ticks_ && image_->failure().empty()) turn(still, standing);
}

RobotDrive BootedImage::turn(RobotSensors sensors, const RobotShafts& shafts) {
  sensors.now_us = static_cast<std::uint64_t>(now_ns() / 1000);
  image_->shafts(shafts);
  const RobotDrive drive = image_->tick(sensors);
  listen();
  ++ticks_;
  return drive;
}

void BootedImage::listen() {
  while (const std::size_t count = image_->radio_transmit(frame_)) {
    if (ear_) ear_->hear(std::span(frame_).first(std::min(count, frame_.size())), now_ns());
  }
  if (!ear_) return;
  const TelemetryReading& t = ear_->told(now_ns());
  if (!std::ranges::all_of(t.omega_wheel_rad_s, [](double v) { return std::isfinite(v); })) return;
  std::ranges::copy(t.omega_wheel_rad_s, told_.omega_wheel_rad_s);
  told_.now_us = static_cast<std::uint64_t>(now_ns() / 1000);
}

}  // namespace omnihil
