// One axis: limits on made-up samples, the board with the shim at the other end of a real line, rows and dataset.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "firmware_iface/remote_shim/remote_plant.h"
#include "hil/acquire/axis_dataset.h"
#include "hil/acquire/axis_watch.h"
#include "hil/acquire/bus_axis.h"
#include "hil/acquire/remote_axis.h"

namespace omnihil {
namespace {

constexpr std::int64_t kMs = 1'000'000;

AxisMoment at(double time_s, double position_rad, double velocity_rad_s) {
  AxisMoment r{.now_ns = std::llround(1e9 * time_s), .time_s = time_s};
  r.position_rad = position_rad, r.velocity_rad_s = velocity_rad_s;
  r.current_A = 0.5, r.bus_V = 24.0;
  return r;
}

TEST(AxisWatch, ALimitThatIsPassedIsNamedWithItsValue) {
  PlanLimits limits;
  limits.speed_rad_s = 100.0, limits.travel_rad = 2.0, limits.current_A = 3.0, limits.silence_s = 0.1;
  AxisWatch watch(limits);
  EXPECT_NE(watch.broken(0).find("not answered at all"), std::string::npos);
  watch.told(at(1.0, 10.0, 0.0));
  watch.begin(1000 * kMs);
  EXPECT_EQ(watch.broken(1050 * kMs), "");
  EXPECT_NE(watch.broken(1101 * kMs).find("allowed are 0.1 s"), std::string::npos);
  watch.told(at(1.1, 11.9, 99.0));
  EXPECT_EQ(watch.broken(1100 * kMs), "");
  watch.told(at(1.1, 12.1, 99.0));
  EXPECT_NE(watch.broken(1100 * kMs).find("2.1 rad from its start"), std::string::npos);
  watch.told(at(1.2, 11.0, -101.0));
  EXPECT_NE(watch.broken(1200 * kMs).find("-101 rad/s"), std::string::npos);
  AxisMoment hot = at(1.3, 11.0, 0.0);
  hot.current_A = -3.1;
  watch.told(hot);
  EXPECT_NE(watch.broken(1300 * kMs).find("-3.1 A"), std::string::npos);
  watch.told(at(1.4, 11.0, 0.0));
  watch.trouble("a fault");
  EXPECT_EQ(watch.broken(1400 * kMs), "a fault");
}

TEST(AxisWatch, ASupplyThatDipsIsTakenOneThatStaysLowIsNot) {
  PlanLimits limits;
  limits.battery_V = 20.0, limits.silence_s = 10.0;
  AxisWatch watch(limits);
  for (int k = 0; k < 10; ++k) {
    AxisMoment r = at(0.01 * k, 0.0, 0.0);
    r.bus_V = k < 5 ? 19.0 : 21.0;
    watch.told(r);
    EXPECT_EQ(watch.broken(r.now_ns), "") << k;
  }
  std::string why;
  for (int k = 10; k < 40 && why.empty(); ++k) {
    AxisMoment r = at(0.01 * k, 0.0, 0.0);
    r.bus_V = 19.5;
    watch.told(r);
    why = watch.broken(r.now_ns);
    if (!why.empty()) {
      EXPECT_EQ(k, 30);  // low from 0.10 s on, 0.2 s later
    }
  }
  EXPECT_NE(why.find("19.50 V"), std::string::npos);
}

TEST(AxisWatch, ARunWaitsForAnAxisThatStandsStill) {
  PlanLimits limits;
  limits.silence_s = 10.0;
  AxisWatch watch(limits);
  watch.told(at(0.0, 0.0, 5.0));
  EXPECT_EQ(watch.not_ready(200 * kMs), "the axis does not stand still");
  watch.told(at(0.25, 0.1, 0.0));
  EXPECT_EQ(watch.not_ready(290 * kMs), "the axis does not stand still");
  EXPECT_EQ(watch.not_ready(310 * kMs), "");
}

// A board with motors and the program's end, with a line of memory between them.
struct Line final : ByteWire {
  std::vector<std::uint8_t>*in, *out;
  Line(std::vector<std::uint8_t>* i, std::vector<std::uint8_t>* o) : in(i), out(o) {}
  std::string_view name() const override { return "line"; }
  std::error_code read(std::vector<std::uint8_t>& to, std::size_t limit) override {
    const std::size_t n = std::min(limit, in->size());
    to.insert(to.end(), in->begin(), in->begin() + static_cast<std::ptrdiff_t>(n));
    in->erase(in->begin(), in->begin() + static_cast<std::ptrdiff_t>(n));
    return {};
  }
  std::size_t write(std::span<const std::uint8_t> bytes, std::error_code&) override {
    out->insert(out->end(), bytes.begin(), bytes.end());
    return bytes.size();
  }
};

struct Board {
  std::vector<std::uint8_t> to_board, to_host;
  omnihil_remote_plant plant{};
  RemoteAxis axis{BufferedWire(std::make_unique<Line>(&to_host, &to_board), 4096), 2};
  std::uint32_t now_us = 0xFFFFF000;  // wraps soon

  explicit Board(std::uint16_t timeout = 20, float counts = 4096.0F) {
    omnihil_remote_robot robot{};
    robot.gear_ratio = 2.0F;
    robot.encoder_counts_per_rotor_turn = counts;
    omnihil_remote_plant_init(
        &plant, &robot, timeout,
        [](void* port, const std::uint8_t* bytes, std::size_t n) {
          auto& out = *static_cast<std::vector<std::uint8_t>*>(port);
          out.insert(out.end(), bytes, bytes + n);
        },
        &to_host);
  }
  void period(std::int32_t counts) {
    for (const std::uint8_t byte : std::exchange(to_board, {})) omnihil_remote_plant_receive(&plant, byte);
    now_us += 1000;
    plant.sensors.now_us = now_us;
    plant.sensors.encoder_counts[2] = counts;
    plant.sensors.motor_current_mA[2] = -1500;
    plant.sensors.bus_voltage_mV = 23'500;
    omnihil_remote_plant_tick(&plant);
  }
  void greet() {
    period(0);
    std::string problem;
    ASSERT_TRUE(axis.greet(problem)) << problem;
    period(0);
  }
};

TEST(RemoteAxis, ASampleHasTheDriveThatWasInForceAndTheBoardsClock) {
  Board b;
  b.greet();
  std::vector<AxisMoment> seen;
  b.axis.read(0, seen);
  const double asked[] = {0.25, 0.5, -0.75};
  for (int k = 0; k < 3; ++k) {
    b.axis.ask(asked[k], 0);
    b.period(static_cast<std::int32_t>(0x7FFFFFFEU +
                                       static_cast<unsigned>(k)));  // answers the ask before; wraps at k = 2
    b.axis.read(0, seen);
  }
  b.period(5);
  b.axis.read(0, seen);
  ASSERT_EQ(seen.size(), 5U);
  EXPECT_FALSE(std::isfinite(seen[0].value));
  EXPECT_FALSE(std::isfinite(seen[1].value));  // answered the first sensors: coast
  EXPECT_NEAR(seen[2].value, 0.25, 1e-4);
  EXPECT_NEAR(seen[3].value, 0.5, 1e-4);
  EXPECT_NEAR(seen[4].value, -0.75, 1e-4);
  EXPECT_TRUE(omnihil_remote_plant_drives(&b.plant, 2));
  EXPECT_NEAR(omnihil_remote_plant_duty(&b.plant, 2), -0.75F, 1e-4F);
  EXPECT_FALSE(omnihil_remote_plant_drives(&b.plant, 1));
  for (std::size_t k = 1; k < 5; ++k) EXPECT_NEAR(seen[k].time_s - seen[k - 1].time_s, 1e-3, 1e-9) << k;
  EXPECT_EQ(seen[3].counts - seen[2].counts, 1.0);  // over the wrap of 32 bits
  EXPECT_EQ(seen[2].counts - seen[1].counts, 1.0);
  EXPECT_NEAR(seen[4].current_A, -1.5, 1e-9);
  EXPECT_NEAR(seen[4].bus_V, 23.5, 1e-9);
}

TEST(RemoteAxis, AStopGoesOutAtOnceAndNotWithTheNextSensors) {
  Board b;
  b.greet();
  std::vector<AxisMoment> seen;
  b.axis.ask(0.5, 0);
  b.axis.read(0, seen);
  b.period(0);
  EXPECT_TRUE(omnihil_remote_plant_drives(&b.plant, 2));
  b.axis.stop(0);  // no sensors were read since
  b.period(0);
  EXPECT_FALSE(omnihil_remote_plant_drives(&b.plant, 2));
}

TEST(RemoteAxis, ABoardThatHearsNothingLetsGoAndGreetsWhoeverComesNext) {
  Board b(5);
  b.greet();
  std::vector<AxisMoment> seen;
  b.axis.ask(0.5, 0);
  b.axis.read(0, seen);
  b.period(0);
  for (int k = 0; k < 4; ++k) b.period(0);
  EXPECT_TRUE(omnihil_remote_plant_drives(&b.plant, 2));
  b.period(0);
  EXPECT_FALSE(omnihil_remote_plant_drives(&b.plant, 2));
  b.to_host.clear();
  b.period(0);
  RemoteAxis next(BufferedWire(std::make_unique<Line>(&b.to_host, &b.to_board), 4096), 2);
  std::string problem;
  EXPECT_TRUE(next.greet(problem)) << problem;
}

TEST(RemoteAxis, CountsThatFallWithPositiveRotationAreTurnedRound) {
  Board b(20, -4096.0F);
  b.greet();
  std::vector<AxisMoment> seen;
  b.axis.read(0, seen);
  b.period(-2048);
  b.axis.read(0, seen);
  EXPECT_EQ(b.axis.counts_per_turn(), 4096.0);
  EXPECT_EQ(seen.back().counts - seen.front().counts, 2048.0);
  // half a turn of the rotor is a quarter of the output's at a gear of 2
  EXPECT_NEAR(seen.back().position_rad - seen.front().position_rad, std::numbers::pi / 2.0, 1e-9);
}

// Same power and same torque: v i = 1.5 V_q I_q, and sqrt(3) * sqrt(3)/2 = 1.5.
TEST(BusAxis, AmplitudesBecomeTheDirectCurrentMotorOfDataSheets) {
  const BusAxisSetup s = bus_axis_setup(AxisDemand::kVoltage, true, 3.0, true);
  EXPECT_NEAR(s.current_per_told / s.device_per_asked, 1.5, 1e-12);
  EXPECT_NEAR(s.current_per_told, 8.27 * 2.0 * std::numbers::pi / 60.0,
              2e-4);  // torque constant = 8.27 / Kv (rpm/V)
  EXPECT_EQ(s.turns_per_output, 3.0);
  EXPECT_EQ(bus_axis_setup(AxisDemand::kTorque, true, 3.0, true).device_per_asked, 1.0);
  EXPECT_EQ(bus_axis_setup(AxisDemand::kTorque, false, 3.0, true).device_per_asked, 3.0);
  EXPECT_EQ(bus_axis_setup(AxisDemand::kVoltage, true, 3.0, false).device_per_asked, 1.0);
}

TEST(AxisDataset, RowsRiseAndHoldWhatTheDeviceTells) {
  std::vector<AxisMoment> samples;
  for (int k = 0; k < 4; ++k) {
    samples.push_back(at(0.01 * (k == 3 ? 2 : k), k, 0.0));  // the last came twice
    samples.back().value = k;
  }
  const RunRows rows = axis_rows(samples, PlanDrive::kMotorVoltage);
  EXPECT_EQ(rows.columns,
            (std::vector<std::string>{"motor_voltage", "position", "velocity", "current", "bus"}));
  ASSERT_EQ(rows.time_s.size(), 3U);
  EXPECT_EQ((*rows.column("motor_voltage"))[2], 2.0);
  // A torque is of the row's instant, between the one before and the one after it.
  EXPECT_EQ(*axis_rows(samples, PlanDrive::kMotorTorque).column("motor_torque"),
            (std::vector<double>{0.0, 0.5, 1.5}));
  const PlanRun run{.name = "r", .use = Split::kTraining, .excitation = "", .duration_s = 1.0, .steps = {}};
  AcquirePlan plan;
  plan.drive = PlanDrive::kMotorVoltage;
  const std::string text = axis_dataset_text(plan, {{&run, rows}}, 0.0);
  EXPECT_NE(text.find("motor_voltage = { column = \"motor_voltage\" }"), std::string::npos) << text;
  EXPECT_EQ(text.find("motor_current"), std::string::npos) << text;  // of an instant
  EXPECT_EQ(text.find("velocity"), std::string::npos) << text;
  AcquirePlan by_torque;
  by_torque.drive = PlanDrive::kMotorTorque;
  const std::string torque = axis_dataset_text(by_torque, {{&run, rows}}, 0.0);
  EXPECT_NE(torque.find("velocity = { column = \"velocity\" }"), std::string::npos) << torque;
  AcquirePlan by_duty;
  by_duty.drive = PlanDrive::kDuty;
  const std::string duty = axis_dataset_text(by_duty, {{&run, rows}}, 0.0);
  EXPECT_NE(duty.find("motor_current = { column = \"current\" }"), std::string::npos) << duty;
  EXPECT_EQ(text.find("encoder"), std::string::npos) << text;
}

}  // namespace
}  // namespace omnihil
