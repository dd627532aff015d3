// Instructions a second of the emulated microcontroller on code that never sleeps.
//
//   bench_mcu                prints the table; exit 0 when the target is met, 1 when it is missed
//
// CPU time of this thread over 60 M cycles of a Cortex-M4F, the best of five: four float PID controllers with
// limits, and a CRC over bytes with a table in RAM. Needs the image that the cross compiler builds.
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "bench/cpu_time.h"
#include "firmware_iface/mcu/machine/machine.h"

namespace omnihil {
namespace {

constexpr double kTargetMips = 200;

double mips(const mcu::ElfImage& image, std::uint32_t which) {
  std::vector<std::string> problems;
  mcu::Machine machine({});
  double best = 0;
  for (int repetition = 0; repetition < 5; ++repetition) {
    if (!machine.load(image, problems)) return 0;
    machine.power_on();
    machine.run_until(2'000);
    if (which == 1) machine.cpu().reg.r[15] = *image.address_of("crc_loop") & ~1u;
    if (which == 0) machine.cpu().reg.r[15] = *image.address_of("pid_loop") & ~1u;
    machine.cpu().reg.r[0] = 0x7FFFFFFF;
    const double before_s = thread_cpu_s();
    const auto first = machine.report().instructions;
    machine.run_until(60'000'000);
    const auto done = machine.report().instructions - first;
    best = std::max(best, static_cast<double>(done) / (thread_cpu_s() - before_s) / 1e6);
    if (machine.report().fault_count != 0) std::printf("%s\n", machine.report().faults[0].text().c_str());
  }
  return best;
}

}  // namespace
}  // namespace omnihil

int main() {
  const std::string path = OMNIHIL_BUILD_DIR "/images/loops.elf";
  std::ifstream file(path, std::ios::binary);
  const std::vector<std::uint8_t> bytes((std::istreambuf_iterator<char>(file)), {});
  omnihil::mcu::ElfImage image;
  std::vector<std::string> problems;
  if (!omnihil::mcu::read_elf(bytes, image, problems)) {
    std::printf("%s: %s (is arm-none-eabi-gcc installed?)\n", path.c_str(), problems[0].c_str());
    return 3;
  }
  const double control = omnihil::mips(image, 0), integer = omnihil::mips(image, 1);
  std::printf("float control  %6.0f million instructions a second (at least %.0f)\n", control,
              omnihil::kTargetMips);
  std::printf("integer        %6.0f million instructions a second\n", integer);
  return control >= omnihil::kTargetMips ? 0 : 1;
}
