#include "hil/serve/serve_load.h"

#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <deque>
#include <stdexcept>
#include <utility>

#include "hil/loop/reference_firmware.h"
#include "hil/serve/timed_firmware.h"

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

Session::FirmwareMaker timed(const Session::FirmwareMaker& maker, std::deque<std::int64_t>& spent_ns) {
  if (!maker) return {};
  return [maker, &spent_ns](const RobotConfig& robot) -> std::unique_ptr<Firmware> {
    return std::make_unique<TimedFirmware>(maker(robot), spent_ns.emplace_back(0));
  };
}

// The ratio of the whole, 0: it cannot be made; and of what each robot's boards take of it, if asked for.
double ratio_of(SessionConfig config, Physics physics, LoadFirmware firmware,
                std::vector<ServeLoad::Share>* boards) {
  config.plant.physics = physics;
  config.faults.clear();
  config.from.clear();
  config.threads = 1;
  try {
    if (!firmware.first) firmware.first = reference_firmware_for(config);
    if (!firmware.opponents && !config.opponents.robots.empty())
      firmware.opponents = reference_firmware_for(opponents_alone(config));
    std::deque<std::int64_t> spent_ns;  // by robot
    Session session(config, timed(firmware.first, spent_ns), timed(firmware.opponents, spent_ns));
    RobotCommand ahead{};
    ahead.mode = OMNIHIL_MODE_BODY_VELOCITY;
    ahead.v_forward_m_s = 0.5;
    ahead.omega_body_rad_s = 0.5;
    for (int i = 0; i < session.robot_count(); ++i) session.command(i, ahead);
    std::vector<std::uint8_t> answer;
    while (session.now_ns() < kWarm_ns) session.step({}, answer);
    std::ranges::fill(spent_ns, 0);
    const std::int64_t from_ns = session.now_ns();
    const double from_s = processor_s();
    double spent_s = 0.0;
    while (session.now_ns() < from_ns + kMeasured_ns && spent_s < kLongest_s) {
      answer.clear();
      session.step({}, answer);
      spent_s = processor_s() - from_s;
    }
    const double ratio = spent_s / (1e-9 * static_cast<double>(session.now_ns() - from_ns));
    for (std::size_t i = 0; boards != nullptr && i < spent_ns.size(); ++i) {
      const int index = static_cast<int>(i);
      const bool emulated = session.firmware_chip(index) != nullptr;
      const double share = 1e-9 * static_cast<double>(spent_ns[i]) / spent_s;
      if (emulated) boards->push_back({session.robot_key(index), share * ratio});
    }
    return ratio;
  } catch (const std::exception&) {  // it is named where the bench itself is made
    return 0.0;
  }
}

std::string per_cent(double ratio) { return fmt::format("{:.{}f} %", 100.0 * ratio, ratio < 0.1 ? 1 : 0); }

// "boards of robots 0-2 8.1 % each, of robot 3 9 %": neighbours of one text together.
std::string board_words(const std::vector<ServeLoad::Share>& boards) {
  std::string text;
  for (std::size_t i = 0; i < boards.size();) {
    std::size_t end = i + 1;
    const std::string share = per_cent(boards[i].core_ratio);
    while (end < boards.size() && per_cent(boards[end].core_ratio) == share &&
           boards[end].key == boards[end - 1].key + 1)
      ++end;
    const bool other = boards[i].key >= kOpponentKey, several = end - i > 1;
    const int base = other ? kOpponentKey : 0;
    const std::string who = several ? fmt::format("s {}-{}", boards[i].key - base, boards[end - 1].key - base)
                                    : fmt::format(" {}", boards[i].key - base);
    text += fmt::format("{}{}{} {}{}", text.empty() ? "" : ", ", other ? "opponent" : "robot", who, share,
                        several ? " each" : "");
    i = end;
  }
  return text;
}

}  // namespace

// Boards go where there is room, those of a three-phase robot together.
double ServeLoad::busiest_core_ratio() const {
  double sum = 0.0, largest = 0.0;
  for (const Share& share : boards) {
    sum += share.core_ratio;
    largest = std::max(largest, share.core_ratio);
  }
  return core_ratio - sum + std::max(sum / threads, largest);
}

ServeLoad measured_load(const SessionConfig& config, const LoadFirmware& firmware) {
  ServeLoad load;
  load.planar = config.plant.physics == Physics::kPlanar;
  load.robots = static_cast<int>(config.robots.size() + config.opponents.robots.size());
  load.threads = std::max(1, config.threads);
  load.core_ratio = ratio_of(config, config.plant.physics, firmware, &load.boards);
  if (load.core_ratio >= kTooMuch && !load.planar)
    load.planar_ratio = ratio_of(config, Physics::kPlanar, firmware, nullptr);
  return load;
}

std::string load_words(const ServeLoad& load) {
  if (load.core_ratio <= 0.0) return {};
  std::string text = fmt::format("load about {} of a core for {} robot{} (measured{})\n",
                                 per_cent(load.core_ratio), load.robots, load.robots == 1 ? "" : "s",
                                 load.boards.empty() ? ", with this program's firmware" : "");
  if (!load.boards.empty())
    text += fmt::format("load: of that emulated boards: {}\n", board_words(load.boards));
  const double busiest = load.busiest_core_ratio();
  if (!load.boards.empty() && load.threads > 1)
    text += fmt::format("load: boards shared out over {} cores, {} of the busiest one\n", load.threads,
                        per_cent(busiest));
  if (busiest < kTooMuch) return text;
  text += busiest < 1.0 ? "load: that leaves little; this computer may not keep up\n"
                        : "load: that is more than there is; this computer will not keep up\n";
  const double planar = load.planar_ratio > 0.0 ? load.planar_ratio - (load.core_ratio - busiest) : 0.0;
  if (planar > 0.0 && planar < kTooMuch)
    text +=
        fmt::format("load: --physics planar, the same robots in closed form, takes {}\n", per_cent(planar));
  else
    text += fmt::format("load: fewer robots, or --clock free{}\n",
                        load.planar ? "" : " (--physics planar would not do)");
  return text;
}

}  // namespace omnihil
