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

bool row(const char* name, const ModelBundle& model, int count, Physics physics, long duration_ms,
         double target) {
  std::vector<int> robots;
  for (int id = 0; id < count; ++id) robots.push_back(id);
  std::vector<double> ratio;
  for (int n = 0; n < 5; ++n) ratio.push_back(times_real(model, robots, physics, duration_ms));
  std::sort(ratio.rbegin(), ratio.rend());
  const bool met = ratio[0] >= target;
  std::printf("%-44s %8.1f x %8.1f x", name, ratio[0], ratio[2]);
  if (target > 0.0) std::printf("  at least %3.0f  %s", target, met ? "met" : "MISSED");
  std::printf("\n");
  return met;
}

int run(bool quick) {
  const ModelBundle model = load_model("omni_default", {OMNIHIL_SOURCE_DIR "/models"}).bundle;
  const long ms = quick ? 2'000 : 20'000;
  std::printf("%-44s %10s %10s\n", "whole loop, simulated over CPU time", "best", "median");
  const bool met = row("1 robot, planar, default step", model, 1, Physics::kPlanar, ms, 200.0);
  row("6 robots, planar, default step", model, 6, Physics::kPlanar, ms / 2, 0.0);
  row("1 robot, Simbody, default step", model, 1, Physics::kSimbody, ms / 4, 0.0);
  row("6 robots, Simbody, default step", model, 6, Physics::kSimbody, ms / 8, 0.0);
  return met ? 0 : 1;
}

// One row alone, for a count of its instructions; the milliseconds are printed.
int count(const std::string& row_name, long ms) {
  const ModelBundle model = load_model("omni_default", {OMNIHIL_SOURCE_DIR "/models"}).bundle;
  const Physics physics = row_name.starts_with("planar") ? Physics::kPlanar : Physics::kSimbody;
  std::vector<int> robots = {0};
  if (row_name.ends_with("_six")) robots = {0, 1, 2, 3, 4, 5};
  times_real(model, robots, physics, ms);
  std::printf("%ld\n", ms);
  return 0;
}

}  // namespace
}  // namespace omnihil

int main(int argc, char** argv) {
  if (argc == 4 && std::strcmp(argv[1], "--count") == 0) return omnihil::count(argv[2], std::atol(argv[3]));
  return omnihil::run(argc > 1 && std::strcmp(argv[1], "--quick") == 0);
}
