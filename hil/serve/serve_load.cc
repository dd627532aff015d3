#include "hil/serve/serve_load.h"

#include <fmt/format.h>
#include <time.h>

#include <stdexcept>

#include "hil/loop/reference_firmware.h"

namespace omnihil {
namespace {

constexpr std::int64_t kWarm_ns = 20'000'000, kMeasured_ns = 100'000'000;
constexpr double kLongest_s = 0.3;  // of processor time: a start is not held up longer
// A choice, not a measurement: the least round number that leaves a fifth of the core to the kernel's side of the wires, the
// host and whatever else the computer does. Where a bench really begins to slip depends on those; only from 1 on it must.
constexpr double kTooMuch = 0.8;

double processor_s() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double ratio_of(SessionConfig config, Physics physics) {
  config.plant.physics = physics;
  config.faults.clear();
  config.from.clear();
  try {
    Session::FirmwareMaker opponents;
    if (!config.opponents.robots.empty()) opponents = reference_firmware_for(opponents_alone(config));
    Session session(config, reference_firmware_for(config), opponents);
    RobotCommand ahead{};
    ahead.mode = OMNIHIL_MODE_BODY_VELOCITY;
    ahead.v_forward_m_s = 0.5;
    ahead.omega_body_rad_s = 0.5;
    for (int i = 0; i < session.robot_count(); ++i) session.command(i, ahead);
    std::vector<std::uint8_t> answer;
    while (session.now_ns() < kWarm_ns) session.step({}, answer);
    const std::int64_t from_ns = session.now_ns();
    const double from_s = processor_s();
    double spent_s = 0.0;
    while (session.now_ns() < from_ns + kMeasured_ns && spent_s < kLongest_s) {
      answer.clear();
      session.step({}, answer);
      spent_s = processor_s() - from_s;
    }
    return spent_s / (1e-9 * static_cast<double>(session.now_ns() - from_ns));
  } catch (const std::exception&) {  // it is named where the bench itself is made
    return 0.0;
  }
}

std::string per_cent(double ratio) { return fmt::format("{:.{}f} %", 100.0 * ratio, ratio < 0.1 ? 1 : 0); }

}  // namespace

ServeLoad measured_load(const SessionConfig& config) {
  ServeLoad load;
  load.planar = config.plant.physics == Physics::kPlanar;
  load.robots = static_cast<int>(config.robots.size() + config.opponents.robots.size());
  load.core_ratio = ratio_of(config, config.plant.physics);
  if (load.core_ratio >= kTooMuch && !load.planar) load.planar_ratio = ratio_of(config, Physics::kPlanar);
  return load;
}

std::string load_words(const ServeLoad& load) {
  if (load.core_ratio <= 0.0) return {};
  std::string text =
      fmt::format("load about {} of a core for {} robot{} (measured, with this program's firmware)\n",
                  per_cent(load.core_ratio), load.robots, load.robots == 1 ? "" : "s");
  if (load.core_ratio < kTooMuch) return text;
  text += load.core_ratio < 1.0 ? "load: that leaves little; this computer may not keep up\n"
                                : "load: that is more than there is; this computer will not keep up\n";
  if (load.planar_ratio > 0.0 && load.planar_ratio < kTooMuch)
    text += fmt::format("load: --physics planar, the same robots in closed form, takes {}\n",
                        per_cent(load.planar_ratio));
  else
    text += fmt::format("load: fewer robots, or --clock free{}\n",
                        load.planar ? "" : " (--physics planar would not do)");
  return text;
}

}  // namespace omnihil
