// What the whole loop costs: dongle, firmware, plant and telemetry, with robots that are driven.
//
//   bench_loop               prints the table; exit 0 when the target is met, 1 when it is missed
//   bench_loop --quick       a tenth of the simulated time
//
// Simulated time over CPU time of this thread, the best and the median of five. Each robot gets a SPEED_MOVE
// 30 times a second with a velocity that changes all the time, and is asked for its battery twice a second.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <string_view>
#include <vector>

#include "bench/cpu_time.h"
#include "firmware_iface/host_firmware.h"
#include "hil/recording/session_setup.h"
#include "protocols/radio_format.h"

namespace omnihil {
namespace {

// What an AI host would write at this millisecond.
void host_writes(long ms, const std::vector<int>& robots, std::vector<std::uint8_t>& bytes) {
  static const RadioFormat& format = *find_radio_format("ulaval-hermes");  // a link finds it once
  for (int robot : robots) {
    const double t_s = 1e-3 * static_cast<double>(ms) + 0.4 * robot;
    Values values;
    if (ms % 33 == 0) {
      values.message = format.find("SPEED_MOVE");
      values.set("robot", robot);
      values.set("vx", 1.5 * std::sin(1.3 * t_s));
      values.set("vy", 1.0 * std::sin(0.7 * t_s));
      values.set("vtheta", 2.0 * std::sin(0.9 * t_s));
      format.encode(values, bytes);
    }
    if (ms % 500 == 250) {
      values = Values{};
      values.message = format.find("GET_BATTERIE");
      values.set("robot", robot);
      format.encode(values, bytes);
    }
  }
}

double times_real(const ModelBundle& model, const std::vector<int>& robots, Physics physics,
                  long duration_ms) {
  SessionSetup setup;
  setup.model = model;
  setup.radio_format = "ulaval-hermes";
  setup.robot_ids = robots;
  setup.plant.physics = physics;
  Session session(session_config(setup), make_reference_firmware);
  std::vector<std::uint8_t> host, answer;
  const double start_s = thread_cpu_s();
  for (long ms = 0; ms < duration_ms; ++ms) {
    host.clear();
    answer.clear();
    host_writes(ms, robots, host);
    session.step(host, answer);
  }
  return 1e-3 * static_cast<double>(duration_ms) / (thread_cpu_s() - start_s);
}

struct Row {
  const char *word, *text;  // word: of --count
  int robots;
  Physics physics;
  long share;     // of the measuring time: a whole one over this
  double target;  // 0: none
};
constexpr Row kRows[] = {
    {"planar", "1 robot, planar, default step", 1, Physics::kPlanar, 1, 200.0},
    {"planar_six", "6 robots, planar, default step", 6, Physics::kPlanar, 2, 0.0},
    {"simbody", "1 robot, Simbody, default step", 1, Physics::kSimbody, 4, 0.0},
    {"simbody_six", "6 robots, Simbody, default step", 6, Physics::kSimbody, 8, 0.0},
};
std::vector<int> robots_of(const Row& r) {
  std::vector<int> robots;
  for (int id = 0; id < r.robots; ++id) robots.push_back(id);
  return robots;
}
ModelBundle model() { return load_model("omni_default", {OMNIHIL_SOURCE_DIR "/models"}).bundle; }

int run(bool quick) {
  const ModelBundle omni = model();
  std::printf("%-44s %10s %10s\n", "whole loop, simulated over CPU time", "best", "median");
  bool all = true;
  for (const Row& r : kRows) {
    std::vector<double> ratio;
    for (int n = 0; n < 5; ++n)
      ratio.push_back(times_real(omni, robots_of(r), r.physics, (quick ? 2'000 : 20'000) / r.share));
    std::sort(ratio.rbegin(), ratio.rend());
    const bool met = ratio[0] >= r.target;
    std::printf("%-44s %8.1f x %8.1f x", r.text, ratio[0], ratio[2]);
    if (r.target > 0.0) std::printf("  at least %3.0f  %s", r.target, met ? "met" : "MISSED");
    std::printf("\n");
    all = all && met;
  }
  return all ? 0 : 1;
}

// One row alone, for a count of its instructions; the milliseconds are printed.
int count(std::string_view word, long ms) {
  for (const Row& r : kRows) {
    if (word != r.word) continue;
    times_real(model(), robots_of(r), r.physics, ms);
    std::printf("%ld\n", ms);
    return 0;
  }
  return 2;
}

}  // namespace
}  // namespace omnihil

int main(int argc, char** argv) {
  if (argc == 4 && std::strcmp(argv[1], "--count") == 0) return omnihil::count(argv[2], std::atol(argv[3]));
  return omnihil::run(argc > 1 && std::strcmp(argv[1], "--quick") == 0);
}
