// Waits that are passed by arithmetic, in images that none of us wrote: the same run with every turn of them executed leaves
// the same bits.
#include <cctype>
#include <cmath>
#include <cstdio>
#include <functional>

#include "tests/hil/firmware/third_party.h"

namespace omnihil {
namespace {

struct Row {
  const char *image, *board;
  double duration_s;
  std::function<std::vector<std::uint8_t>()> frame =
      {};  // by radio, every 20 ms; with it motors are driven at the end
};

void PrintTo(const Row& row, std::ostream* out) { *out << row.image; }

struct ThirdPartyWaits : ThirdPartyImage, testing::WithParamInterface<Row> {
  ThirdPartyWaits() : ThirdPartyImage(GetParam().image, GetParam().board) {}
  std::unique_ptr<mcu::McuBoard> run(bool passed) {
    auto ran = board();
    ran->machine().cpu().fast_forward = passed;
    mcu::WorldState world;
    world.bus_voltage_V = 16.0;
    world.gear_ratio = 3.0;
    for (std::size_t w = 0; w < kWheels; ++w)
      world.omega_rotor_rad_s[w] = 10.0 + 3.0 * static_cast<double>(w);
    ran->set_world(world);
    const std::vector<std::uint8_t> frame =
        GetParam().frame ? GetParam().frame() : std::vector<std::uint8_t>{};
    for (std::int64_t at_ns = 0; at_ns < std::llround(GetParam().duration_s * 1e9); at_ns += kStep_ns) {
      ran->run_until_ns(at_ns + kStep_ns);
      if (!frame.empty() && at_ns % 20'000'000 == 0) ran->radio_receive(frame);
    }
    return ran;
  }
  static constexpr std::int64_t kStep_ns = 500'000;
};

TEST_P(ThirdPartyWaits, SlowPassedOrExecutedLeaveTheSameBits) {
  const auto passed = run(true), executed = run(false);
  EXPECT_EQ(passed->machine().now(), executed->machine().now());
  EXPECT_TRUE(passed->machine().cpu().reg == executed->machine().cpu().reg);
  EXPECT_EQ(passed->machine().report().instructions, executed->machine().report().instructions);
  EXPECT_EQ(executed->machine().report().skipped_cycles, 0u);
  EXPECT_EQ(report(*passed), report(*executed));
  for (const mcu::MemorySpec& memory : spec_->chip->memories) {
    std::vector<std::uint8_t> one(memory.bytes), other(memory.bytes);
    passed->machine().memory().read(memory.base, one);
    executed->machine().memory().read(memory.base, other);
    EXPECT_TRUE(one == other) << memory.name;
  }
  for (const mcu::MotorEntry& motor : spec_->motors) {
    const mcu::BridgeDrive one = passed->wire(motor.wheel)->now(), other = executed->wire(motor.wheel)->now();
    EXPECT_EQ(one.driven, other.driven);
    EXPECT_EQ(one.duty_ratio, other.duty_ratio);
    if (GetParam().frame) {
      EXPECT_NE(one.duty_ratio, 0.0) << "the command has not arrived";
    }
  }
  std::printf("%.0f %% of the time passed\n",
              100.0 * static_cast<double>(passed->machine().report().skipped_cycles) /
                  static_cast<double>(passed->machine().now()));
}

INSTANTIATE_TEST_SUITE_P(
    Images, ThirdPartyWaits,
    testing::Values(Row{"ulaval-f407.elf", "ulaval_delta_f407.toml", 1.5,
                        [] {
                          return hermes_packet("SPEED_MOVE", {{"vx", 1.0}, {"vy", 0.3}, {"vtheta", 0.5}});
                        }},
                    Row{"roboteam-top-f767.elf", "roboteam_top_f767.toml", 9.2,
                        [] { return rem_command(0, 1.0, 0.3, 0.5); }},
                    Row{"ateam-wheel.elf", "ateam_wheel_f031.toml", 0.5},
                    Row{"ibis-f303.elf", "ibis_bldc_f303.toml", 0.5},
                    Row{"mini-cheetah-f446.elf", "mini_cheetah_f446.toml", 0.5},
                    Row{"vesc-410-f405.elf", "vesc_410_f405.toml", 0.5},
                    Row{"odrive-36-f405.elf", "odrive_36_f405.toml", 0.5}),
    [](const auto& row) {
      std::string name = row.param.image;
      for (char& c : name) {
        if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
      }
      return name;
    });

}  // namespace
}  // namespace omnihil
