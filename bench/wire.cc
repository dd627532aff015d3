// How long after its due time an answer is with the host: from a command on a wire to its answer, less what the simulation
// itself takes (the wait for the next step, and the steps that the radio takes). Beside a bare echo over the same wire.
//
//   bench_wire            prints the table; exit 0 when every target is met, 1 when one is missed
//   bench_wire --quick    a tenth of the commands
//   bench_wire --fifo     bench, echo and host with real-time scheduling: beside other work
//
// Each wire twice: a bench that sleeps up to each step, and one that is awake for its last 400 us (`serve --spin 400`).
//
// The bench is `serve` in a process of its own, in real time, in steps of 1 ms; the host is this process: it sends a
// PING_REQUEST of ulaval-hermes at random times, one at a time, and waits for the answer. Step k is due at start + k ms, and
// start is known to both. A command is taken by the first step after it was sent, and its answer leaves with the step that
// is n - 1 later, n by the radio's own time on the air, the same for all; how long after that step was due the host has it
// is what is counted. The echo is a process that reads and writes back.
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "bench/wire_ends.h"
#include "firmware_iface/host_firmware.h"
#include "hil/loop/clock.h"
#include "hil/recording/recording_header.h"
#include "hil/recording/session_setup.h"
#include "hil/serve/serve.h"
#include "protocols/radio_format.h"

namespace omnihil {
namespace {

constexpr std::int64_t kHeadStart_ns = 1'000'000'000;  // until step 0: the bench's models are read by then

// Longer than nearly every wake-up of a virtual machine took (p99 of `serve`'s lateness there: 0.1 to 0.2 ms).
constexpr std::int64_t kAwake_us = 400;

std::vector<std::uint8_t> ping() {
  const RadioFormat& format = *find_radio_format("ulaval-hermes");
  Values values;
  values.message = format.find("PING_REQUEST");
  values.set("robot", 0);
  std::vector<std::uint8_t> bytes;
  format.encode(values, bytes);
  return bytes;
}

struct Case {
  const char* name;
  Wire wire;
  Physics physics;
  bool league;
  std::int64_t spin_us;
  double most_us;  // of p99; 0: no target
};

struct How {
  bool quick = false;
  bool fifo = false;
};

// Empty when the bench fell behind: then its steps are no longer where they were.
Times turnaround(const Case& what, const ModelBundle& model, int count, const How& how) {
  SessionSetup setup;
  setup.model = model;
  setup.radio_format = "ulaval-hermes";
  setup.robot_ids = {0, 1, 2, 3, 4, 5};
  setup.plant.physics = what.physics;
  setup.step_ns = kStep_ns;
  ServeOptions options;
  const std::string path =
      (std::filesystem::temp_directory_path() / ("omnihil-bench-" + std::to_string(::getpid()))).string();
  const std::uint16_t port = free_port();
  options.device = what.wire == Wire::kUdp ? "udp:127.0.0.1:" + std::to_string(port) : path;
  options.quiet = options.strict = true;
  options.fifo = how.fifo;
  options.spin_ns = 1'000 * what.spin_us;
  if (what.league) {
    options.league = LeagueOptions{};
    options.league->control_port = free_port();
    options.league->robot_port = free_port();
    options.league->vision_port = free_port();
  }
  options.start_ns = monotonic_now_ns() + kHeadStart_ns;
  const pid_t bench = child(false, [&] {
    const int nowhere = ::open("/dev/null", O_WRONLY);
    ::dup2(nowhere, STDOUT_FILENO);
    const SessionConfig config = session_config(setup);
    return static_cast<int>(serve(config, make_reference_firmware, recording_header(setup, ""), options));
  });
  sleep_ns(options.start_ns - monotonic_now_ns() + 20 * kStep_ns);
  const Descriptor ours = what.wire == Wire::kUdp ? udp_to(port) : serial_port(path);
  std::vector<std::pair<std::int64_t, std::int64_t>> seen;
  const bool whole = ask(ours.get(), ping(), count, [&](std::int64_t sent_ns, std::int64_t came_ns) {
    seen.emplace_back(sent_ns, came_ns);
  });
  const bool on_time = end_of(bench, SIGTERM) == static_cast<int>(ServeEnd::kDone) && whole;
  Times times;
  if (!on_time) return times;
  // The step that takes a command is the first that is due after it.
  const auto due_ns = [&](std::int64_t sent_ns) {
    const std::int64_t steps = (sent_ns - options.start_ns + kStep_ns - 1) / kStep_ns;
    return options.start_ns + steps * kStep_ns;
  };
  std::map<std::int64_t, int> later;  // whole steps from there to the answer: how often
  for (const auto& [sent_ns, came_ns] : seen) ++later[(came_ns - due_ns(sent_ns)) / kStep_ns];
  const auto usual = std::max_element(later.begin(), later.end(),
                                      [](const auto& a, const auto& b) { return a.second < b.second; });
  for (const auto& [sent_ns, came_ns] : seen) {
    std::int64_t over_ns = came_ns - due_ns(sent_ns) - usual->first * kStep_ns;
    if (over_ns < 0) over_ns += kStep_ns;  // a step that began late has taken what was sent after it was due
    times.us.push_back(1e-3 * static_cast<double>(over_ns));
  }
  return times;
}

int run(const How& how) {
  const ModelBundle model = load_model("omni_default", {OMNIHIL_SOURCE_DIR "/models"}).bundle;
  const int count = how.quick ? 200 : 2'000;
  if (how.fifo) {
    const std::string refused = become_realtime(kFifoPriority);
    if (!refused.empty()) {
      std::printf("--fifo: %s\n", refused.c_str());
      return 2;
    }
  }
  constexpr Case kCases[] = {
      {"UDP, six robots, planar", Wire::kUdp, Physics::kPlanar, false, 0, 0.0},
      {"UDP, six robots, planar, awake", Wire::kUdp, Physics::kPlanar, false, kAwake_us, 150.0},
      {"pty, six robots, planar", Wire::kPty, Physics::kPlanar, false, 0, 0.0},
      {"pty, six robots, planar, awake", Wire::kPty, Physics::kPlanar, false, kAwake_us, 250.0},
      {"UDP, six robots, planar, league's ports, awake", Wire::kUdp, Physics::kPlanar, true, kAwake_us, 0.0},
      {"UDP, six robots, Simbody, awake", Wire::kUdp, Physics::kSimbody, false, kAwake_us, 0.0}};
  std::printf("%-46s %15s %15s %15s\n", "us, of the answers to commands", "over the step", "bare echo",
              "difference");
  std::printf("%-46s %7s %7s %7s %7s %7s %7s\n", "", "p50", "p99", "p50", "p99", "p50", "p99");
  bool met = true;
  for (const Case& what : kCases) {
    Times bare = echo(what.wire, ping(), count, how.fifo);
    Times over;
    for (int n = 0; n < 5 && over.us.empty(); ++n) over = turnaround(what, model, count, how);
    if (over.us.empty()) {
      std::printf("%-46s fell behind real time five times: no figure\n", what.name);
      met = met && what.most_us <= 0.0;
      continue;
    }
    std::printf("%-46s %7.0f %7.0f %7.0f %7.0f %7.0f %7.0f", what.name, over.quantile(0.5),
                over.quantile(0.99), bare.quantile(0.5), bare.quantile(0.99),
                over.quantile(0.5) - bare.quantile(0.5), over.quantile(0.99) - bare.quantile(0.99));
    if (what.most_us > 0.0) {
      const bool within = over.quantile(0.99) <= what.most_us;
      met = met && within;
      std::printf("  p99 at most %3.0f  %s", what.most_us, within ? "met" : "MISSED");
    }
    std::printf("\n");
    std::fflush(stdout);
  }
  return met ? 0 : 1;
}

}  // namespace
}  // namespace omnihil

int main(int argc, char** argv) {
  omnihil::How how;
  for (int n = 1; n < argc; ++n) {
    how.quick = how.quick || std::strcmp(argv[n], "--quick") == 0;
    how.fifo = how.fifo || std::strcmp(argv[n], "--fifo") == 0;
  }
  return omnihil::run(how);
}
