// The binary boundary is frozen: sizes and places of every struct of ABI version 1 on a 64-bit host.
#include <dlfcn.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "firmware_iface/omnihil_firmware.h"

namespace {

static_assert(OMNIHIL_FIRMWARE_ABI == 1u && OMNIHIL_WHEELS == 4 && OMNIHIL_LOOPS == 5);

// command: 4 x u32, then 3 + 4 + 4 + 7 doubles
static_assert(sizeof(omnihil_command) == 16 + 8 * (3 + 4 + 4 + 7));
static_assert(offsetof(omnihil_command, v_forward_m_s) == 16);
static_assert(offsetof(omnihil_command, omega_wheel_rad_s) == 40);
static_assert(offsetof(omnihil_command, duty_ratio) == 72);
static_assert(offsetof(omnihil_command, yaw_target_rad) == 104);
static_assert(offsetof(omnihil_command, v_kick_m_s) == 136);
static_assert(offsetof(omnihil_command, dribbler_ratio) == 152);
// sensors: time, 4 counts, 4 currents, 4 doubles, 2 x u32
static_assert(sizeof(omnihil_sensors) == 8 + 8 * 4 + 8 * 4 + 8 * 4 + 8 + 8);
static_assert(offsetof(omnihil_sensors, encoder_counts) == 8);
static_assert(offsetof(omnihil_sensors, motor_current_A) == 40);
static_assert(offsetof(omnihil_sensors, bus_voltage_V) == 72);
static_assert(offsetof(omnihil_sensors, ball_seen) == 104);
static_assert(offsetof(omnihil_sensors, capacitor_V) == 112);  // appended: what came before stays
// drive: 4 x u32, 4 doubles, dribbler, 2 x u32, pulse
static_assert(sizeof(omnihil_drive) == 16 + 32 + 8 + 8 + 8);
static_assert(offsetof(omnihil_drive, duty_ratio) == 16);
static_assert(offsetof(omnihil_drive, dribbler_ratio) == 48);
static_assert(offsetof(omnihil_drive, kick) == 56);
static_assert(offsetof(omnihil_drive, kick_pulse_s) == 64);
static_assert(sizeof(omnihil_gains) == 8 * 4 * OMNIHIL_LOOPS);
// feedback: time, 2 x u32, 8 doubles, 5 x 4 wheel values, 4 x 4 body values, dribbler
static_assert(sizeof(omnihil_feedback) == 16 + 8 * (8 + 20 + 16 + 1));
static_assert(offsetof(omnihil_feedback, battery_V) == 16);
static_assert(offsetof(omnihil_feedback, omega_wheel_rad_s) == 80);
static_assert(offsetof(omnihil_feedback, body_integral) == 240);
static_assert(offsetof(omnihil_feedback, omega_dribbler_rad_s) == 368);
static_assert(sizeof(omnihil_robot_config) == 8 + 8 * (4 + 8));
static_assert(offsetof(omnihil_robot_config, wheel_radius_m) == 40);
static_assert(offsetof(omnihil_robot_config, command_timeout_s) == 96);
// the first table ended behind feedback(): libraries that have no more are still served
static_assert(offsetof(omnihil_firmware_api, motor_init) == 2 * 4 + 2 * 8 + 2 * 4 + 8 * 8);
static_assert(sizeof(omnihil_firmware_api) == offsetof(omnihil_firmware_api, motor_init) + 2 * 8);
static_assert(sizeof(omnihil_motor_config) == 8 + 8 * 8);
static_assert(offsetof(omnihil_motor_config, pwm_frequency_Hz) == 8);
static_assert(offsetof(omnihil_motor_config, current_limit_A) == 64);
// motor sensors: time, bus, 4 x 3 currents, 4 angles, 4 counts, 4 x u32
static_assert(sizeof(omnihil_motor_sensors) == 8 + 8 + 8 * 12 + 8 * 4 + 8 * 4 + 4 * 4 + 8 * 12);
static_assert(offsetof(omnihil_motor_sensors, phase_current_A) == 16);
static_assert(offsetof(omnihil_motor_sensors, theta_elec_rad) == 112);
static_assert(offsetof(omnihil_motor_sensors, encoder_counts) == 144);
static_assert(offsetof(omnihil_motor_sensors, hall_code) == 176);
static_assert(offsetof(omnihil_motor_sensors, leg_V) == 192);
static_assert(sizeof(omnihil_motor_drive) == 4 * 12 + 8 * 12);
static_assert(offsetof(omnihil_motor_drive, leg_duty_ratio) == 48);
static_assert(offsetof(omnihil_firmware_api, init) == 32);
static_assert(offsetof(omnihil_firmware_api, feedback) == 88);

static_assert(std::is_trivially_copyable_v<omnihil_command> && std::is_standard_layout_v<omnihil_command>);
static_assert(std::is_trivially_copyable_v<omnihil_feedback> && std::is_standard_layout_v<omnihil_feedback>);

const std::string kLibrary =
    std::string(OMNIHIL_BUILD_DIR) + "/firmware_iface/libomnihil_reference_firmware.so";

std::string output_of(const std::string& command) {
  std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  std::string text;
  char part[256];
  while (pipe && std::fgets(part, sizeof part, pipe.get()) != nullptr) text += part;
  return text;
}

TEST(FirmwareAbi, LibraryExportsExactlyOneSymbol) {
  const std::string symbols = output_of("nm --dynamic --defined-only --format=posix " + kLibrary);
  EXPECT_EQ(symbols.substr(0, symbols.find(' ')), "omnihil_firmware_get");
  EXPECT_EQ(std::count(symbols.begin(), symbols.end(), '\n'), 1) << symbols;
}

TEST(FirmwareAbi, LibraryServesItsAbiVersionAndNoOther) {
  std::unique_ptr<void, int (*)(void*)> library(dlopen(kLibrary.c_str(), RTLD_NOW | RTLD_LOCAL), dlclose);
  ASSERT_NE(library, nullptr) << dlerror();
  using Get = const omnihil_firmware_api* (*)(std::uint32_t);
  const auto get = reinterpret_cast<Get>(dlsym(library.get(), "omnihil_firmware_get"));
  ASSERT_NE(get, nullptr);
  EXPECT_EQ(get(0), nullptr);
  EXPECT_EQ(get(OMNIHIL_FIRMWARE_ABI + 1), nullptr);
  const omnihil_firmware_api* api = get(OMNIHIL_FIRMWARE_ABI);
  ASSERT_NE(api, nullptr);
  EXPECT_EQ(api->struct_bytes, sizeof(omnihil_firmware_api));
  EXPECT_STREQ(api->radio_format, "ulaval-hermes");
}

// As docs/firmware.md advises: everything else hidden, the entry is not.
TEST(FirmwareAbi, ALibraryWithHiddenVisibilityExportsItsEntry) {
  const std::string folder = testing::TempDir(), include = " -I" OMNIHIL_SOURCE_DIR " ";
  for (const auto& [compiler, suffix, linkage] :
       {std::array<std::string, 3>{"cc -std=c11", "c", ""},
        std::array<std::string, 3>{"c++ -std=c++20", "cc", "extern \"C\" "}}) {
    const std::string source = folder + "/hidden." + suffix,
                      made = folder + "/libhidden_" + suffix + std::to_string(::getpid()) + ".so";
    std::ofstream(source) << "#include \"firmware_iface/omnihil_firmware.h\"\n"
                          << linkage << "int helper(void);\n"
                          << linkage << "int helper(void) { return 1; }\n"
                          << linkage
                          << "const omnihil_firmware_api* omnihil_firmware_get(uint32_t version) {\n"
                          << "  return version == 99u ? 0 : (const omnihil_firmware_api*)0;\n}\n";
    ASSERT_EQ(
        std::system(
            (compiler + " -shared -fPIC -fvisibility=hidden" + include + source + " -o " + made).c_str()),
        0);
    EXPECT_NE(output_of("nm --dynamic --defined-only " + made).find(" T omnihil_firmware_get"),
              std::string::npos);
    EXPECT_EQ(output_of("nm --dynamic --defined-only " + made).find("helper"), std::string::npos);
    std::unique_ptr<void, int (*)(void*)> library(dlopen(made.c_str(), RTLD_NOW | RTLD_LOCAL), dlclose);
    ASSERT_NE(library, nullptr) << dlerror();
    EXPECT_NE(dlsym(library.get(), "omnihil_firmware_get"), nullptr) << suffix;
    std::remove(made.c_str());
    std::remove(source.c_str());
  }
}

// The header stands alone, as the language standards have it, in both languages.
TEST(FirmwareAbi, HeaderCompilesAsStrictC11AndCxx20) {
  const std::string header = std::string(OMNIHIL_SOURCE_DIR) + "/firmware_iface/omnihil_firmware.h";
  const std::string strict = " -Wall -Wextra -Wpedantic -Wconversion -Werror -fsyntax-only ";
  EXPECT_EQ(std::system(("cc -std=c11 -x c" + strict + header).c_str()), 0);
  EXPECT_EQ(std::system(("c++ -std=c++20 -x c++ -Wno-pragma-once-outside-header" + strict + header).c_str()),
            0);
}

// A microcontroller build: 32-bit pointers and soft double alignment are the compiler's; no library but
// memcpy, memset and the float functions of libm is called.
TEST(FirmwareAbi, ReferenceFirmwareNeedsNoHeapAndNoInputOutput) {
  const std::string symbols = output_of("nm --dynamic --undefined-only --format=posix " + kLibrary);
  for (const char* forbidden : {"malloc", "calloc", "realloc", "free", "printf", "fprintf", "puts", "abort",
                                "time", "clock_gettime", "read", "write", "fopen"}) {
    EXPECT_EQ(symbols.find(std::string("\n") + forbidden + "@"), std::string::npos) << symbols;
    EXPECT_EQ(symbols.find(std::string("\n") + forbidden + " "), std::string::npos) << symbols;
  }
}

}  // namespace
