// The same work compiled for the core and for the host: one checksum, whatever the optimisation and the FPU.
#include "tests/firmware_iface/mcu/images/torture.h"

#include <cstdio>
#include <ostream>

#include "tests/firmware_iface/mcu/image_bench.h"

namespace omnihil::mcu {
namespace {

struct Build {
  const char* image;
  const Variant* variant;
  const char* qemu_machine;  // one with this core and this memory map; null: none
};
void PrintTo(const Build& build, std::ostream* out) { *out << build.image; }

constexpr Build kBuilds[] = {
    {"torture_m0_os", &kCortexM0, nullptr},           {"torture_m3_o0", &kCortexM3, "netduino2"},
    {"torture_m3_o2", &kCortexM3, "netduino2"},       {"torture_m4_soft_os", &kCortexM4, "netduinoplus2"},
    {"torture_m4f_o0", &kCortexM4F, "netduinoplus2"}, {"torture_m4f_os", &kCortexM4F, "netduinoplus2"},
    {"torture_m4f_o2", &kCortexM4F, "netduinoplus2"}, {"torture_m7_o0", &kCortexM7, nullptr},
    {"torture_m7_o3", &kCortexM7, nullptr},
};

class TortureTest : public ::testing::TestWithParam<Build> {
 protected:
  void SetUp() override { OMNIHIL_NEED_IMAGES(); }
};

TEST_P(TortureTest, ChecksumIsTheHosts) {
  MachineConfig config;
  config.variant = *GetParam().variant;
  ImageBench bench(GetParam().image, config);
  bench.machine.set_breakpoint_hook([](std::uint32_t number) { return number == 0xAB; });
  ASSERT_TRUE(bench.run(200'000'000));
  EXPECT_EQ(bench.word("result"), torture_crc());
  EXPECT_EQ(bench.machine.report().fault_count, 0u);
}

TEST_P(TortureTest, QemuPrintsTheSame) {
  const char* machine = GetParam().qemu_machine;
  if (!machine) GTEST_SKIP() << "qemu-system-arm has no machine with this core and memory map";
  if (std::system("command -v qemu-system-arm >/dev/null 2>&1") != 0) {
    GTEST_SKIP() << "qemu-system-arm is not installed";
  }
  const std::string command =
      std::string("timeout 60 qemu-system-arm -nographic -monitor none -serial none -M ") + machine +
      " -semihosting -kernel " OMNIHIL_BUILD_DIR "/images/" + GetParam().image + ".elf 2>&1 </dev/null";
  std::string printed;
  FILE* pipe = popen(command.c_str(), "r");
  ASSERT_NE(pipe, nullptr);
  for (int c = fgetc(pipe); c != EOF; c = fgetc(pipe)) printed += static_cast<char>(c);
  pclose(pipe);
  char expected[16];
  std::snprintf(expected, sizeof expected, "%08x\n", torture_crc());
  EXPECT_EQ(printed, expected);
}

INSTANTIATE_TEST_SUITE_P(Builds, TortureTest, ::testing::ValuesIn(kBuilds),
                         [](const auto& of) { return std::string(of.param.image).substr(8); });

}  // namespace
}  // namespace omnihil::mcu
