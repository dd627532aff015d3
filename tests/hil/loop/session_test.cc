// The loop itself: order of hops, control grid, determinism, and how it refuses.
#include "hil/loop/session.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "firmware_iface/host_firmware.h"
#include "hil/recording/session_setup.h"
#include "protocols/radio_format.h"

namespace omnihil {
namespace {

using Bytes = std::vector<std::uint8_t>;
constexpr std::int64_t kMs = 1'000'000;

SessionSetup setup_of(const std::string& robot, const std::string& radio, std::vector<int> ids) {
  SessionSetup setup;
  const StoredModel stored = load_robot_model(robot, {OMNIHIL_SOURCE_DIR "/models"});
  EXPECT_TRUE(stored.model.has_value());
  setup.model = stored.bundle;
  setup.radio_format = radio;
  setup.robot_ids = std::move(ids);
  setup.plant.physics = Physics::kPlanar;
  return setup;
}

// Coasts, and writes down when it was called. One of its signals may be made to break.
class ProbeFirmware : public Firmware {
 public:
  explicit ProbeFirmware(std::int64_t period_ns, std::string decodes = "")
      : period_ns_(period_ns), decodes_(std::move(decodes)) {}
  std::string_view name() const override { return "probe"; }
  std::string_view radio_format() const override { return decodes_; }
  std::int64_t control_period_ns() const override { return period_ns_; }
  void command(const RobotCommand&, std::int64_t now_ns) override { commands.push_back(now_ns); }
  void radio_receive(std::span<const std::uint8_t>, std::int64_t now_ns) override {
    frames.push_back(now_ns);
  }
  std::size_t radio_transmit(std::span<std::uint8_t>) override { return 0; }
  bool set_gains(const RobotGains&) override { return false; }
  RobotGains gains() const override { return {}; }
  RobotDrive tick(const RobotSensors& sensors) override {
    ticks_us.push_back(sensors.now_us);
    RobotDrive drive{};
    if (ticks_us.size() == breaks_at_tick) {
      drive.mode[2] = OMNIHIL_DRIVE_DUTY;
      drive.duty_ratio[2] = std::numeric_limits<double>::quiet_NaN();
    }
    return drive;
  }
  RobotFeedback feedback() const override { return {}; }

  std::vector<std::uint64_t> ticks_us;
  std::vector<std::int64_t> commands;
  std::vector<std::int64_t> frames;
  std::size_t breaks_at_tick = 0;

 private:
  std::int64_t period_ns_;
  std::string decodes_;
};

struct Probes {
  std::vector<ProbeFirmware*> made;
  Session::FirmwareMaker maker(std::int64_t period_ns, std::string decodes = "") {
    return [this, period_ns, decodes](const RobotConfig&) {
      auto probe = std::make_unique<ProbeFirmware>(period_ns, decodes);
      made.push_back(probe.get());
      return probe;
    };
  }
};

Bytes encoded(const std::string& format, const std::string& message,
              const std::vector<std::pair<std::string, double>>& fields) {
  const RadioFormat* radio = find_radio_format(format);
  Values values;
  values.message = radio->find(message);
  EXPECT_NE(values.message, nullptr) << message;
  if (values.message == nullptr) return {};
  for (const auto& [name, number] : fields) values.set(name, number);
  Bytes bytes;
  EXPECT_EQ(radio->encode(values, bytes).error, PacketError::kNone);
  return bytes;
}

std::string problems_of(const SessionConfig& config, const Session::FirmwareMaker& maker) {
  try {
    Session session(config, maker);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

// Every event of a run as text, in the order in which the observer saw it.
struct EventLog : SessionObserver {
  void host_bytes(std::int64_t t, std::span<const std::uint8_t> b) override { add("host", t, b.size()); }
  void dongle_bytes(std::int64_t t, std::span<const std::uint8_t> b) override { add("dongle", t, b.size()); }
  void delivery(std::int64_t t, const Delivery& d) override { add("delivery", t, d.robot_id); }
  void robot_tick(std::int64_t t, const RobotSample& s) override { add("tick", t, s.robot_id); }
  void host_closed(std::int64_t t) override { add("closed", t, 0); }
  template <class Number>
  void add(const char* what, std::int64_t t, Number n) {
    text += std::string(what) + " " + std::to_string(t / 1000) + " " + std::to_string(n) + "\n";
  }
  std::string text;
};

TEST(SessionTest, TicksEachRobotOnItsAbsoluteControlGridWhateverTheLoopStep) {
  for (const std::int64_t step_ns : {kMs, 5 * kMs, 7 * kMs, 25 * kMs}) {
    SessionSetup setup = setup_of("omni_default", "ulaval-hermes", {0, 2});
    setup.step_ns = step_ns;
    Probes probes;
    Session session(session_config(setup), probes.maker(10 * kMs));
    Bytes out;
    while (session.now_ns() < 350 * kMs) session.step({}, out);
    EXPECT_EQ(session.now_ns(), 350 * kMs);
    for (const ProbeFirmware* probe : probes.made) {
      ASSERT_EQ(probe->ticks_us.size(), 35u) << step_ns;
      for (std::size_t k = 0; k < 35; ++k) EXPECT_EQ(probe->ticks_us[k], k * 10'000);
    }
  }
}

TEST(SessionTest, TicksSeveralTimesWithinALoopStepThatIsLongerThanTheControlPeriod) {
  SessionSetup setup = setup_of("omni_default", "ulaval-hermes", {0});
  setup.step_ns = 10 * kMs;
  Probes probes;
  Session session(session_config(setup), probes.maker(2 * kMs));
  Bytes out;
  session.step({}, out);
  EXPECT_EQ(probes.made[0]->ticks_us, (std::vector<std::uint64_t>{0, 2000, 4000, 6000, 8000}));
}

TEST(SessionTest, RobotsStartInARowHalfAMetreApart) {
  const SessionSetup setup = setup_of("omni_default", "ulaval-hermes", {1, 4, 7});
  const Session session(session_config(setup), make_reference_firmware);
  for (int i = 0; i < 3; ++i) {
    const RobotTruth truth = session.plant().truth(i);
    EXPECT_EQ(truth.x_m, 0.0);
    EXPECT_EQ(truth.y_m, 0.5 * i);
    EXPECT_EQ(truth.yaw_rad, 0.0);
  }
}

TEST(SessionTest, AFirmwareOfTheSameRadioGetsFramesAndAnotherGetsCommands) {
  const Bytes move = encoded("ulaval-hermes", "SPEED_MOVE", {{"robot", 0}, {"vx", 0.5}});
  for (const bool same : {true, false}) {
    const SessionSetup setup = setup_of("omni_default", "ulaval-hermes", {0});
    Probes probes;
    Session session(session_config(setup), probes.maker(10 * kMs, same ? "ulaval-hermes" : ""));
    Bytes out;
    session.step(move, out);
    for (int k = 0; k < 50; ++k) session.step({}, out);
    EXPECT_EQ(probes.made[0]->frames.size(), same ? 1u : 0u);
    EXPECT_EQ(probes.made[0]->commands.size(), same ? 0u : 1u);
  }
}

TEST(SessionTest, ObserverSeesEventsInTheOrderOfTheHops) {
  const SessionSetup setup = setup_of("omni_default", "ulaval-hermes", {0, 1});
  Probes probes;
  Session session(session_config(setup), probes.maker(10 * kMs, "ulaval-hermes"));
  EventLog log;
  session.set_observer(&log);
  const Bytes move = encoded("ulaval-hermes", "SPEED_MOVE", {{"robot", 1}, {"vx", 0.5}});
  Bytes out;
  session.step(move, out);
  session.host_closed();
  for (int k = 0; k < 10; ++k) session.step({}, out);
  EXPECT_EQ(log.text.find("host 0 " + std::to_string(move.size())), 0u) << log.text;
  EXPECT_LT(log.text.find("tick 0 0"), log.text.find("tick 0 1"));
  EXPECT_NE(log.text.find("closed 1000 0\n"), std::string::npos) << log.text;
  EXPECT_NE(log.text.find("tick 10000 0\ntick 10000 1\n"), std::string::npos) << log.text;
}

TEST(SessionTest, AValueThatIsNotFiniteEndsTheRunNamingTimeRobotAndSignal) {
  const SessionSetup setup = setup_of("omni_default", "ulaval-hermes", {0, 5});
  Probes probes;
  Session session(session_config(setup), probes.maker(10 * kMs));
  probes.made[1]->breaks_at_tick = 4;  // at 30 ms
  Bytes out;
  std::string said;
  try {
    while (session.now_ns() < 100 * kMs) session.step({}, out);
  } catch (const std::runtime_error& error) {
    said = error.what();
  }
  EXPECT_EQ(said, "at 0.030000 s robot 5: drive duty_ratio[2] is not finite; the run ends here");
}

TEST(SessionTest, ARobotWhoseEncodersCountBackwardsDrivesAsOneWhoseEncodersCountForwards) {
  double v_forward_m_s[2]{};
  for (const int direction : {1, -1}) {
    SessionConfig config = session_config(setup_of("omni_default", "ulaval-hermes", {0}));
    config.robots[0].encoder.direction = direction;
    Session session(std::move(config), make_reference_firmware);
    const Bytes move = encoded("ulaval-hermes", "SPEED_MOVE", {{"robot", 0}, {"vx", 0.5}});
    Bytes out;
    for (int k = 0; k < 600; ++k) session.step(k % 50 == 0 ? move : Bytes{}, out);
    v_forward_m_s[direction < 0] = session.plant().truth(0).v_forward_m_s;
    // what the firmware reports has the wheel's sign, not the counter's
    const RobotTruth truth = session.plant().truth(0);
    for (std::size_t i = 0; i < kWheels; ++i) {
      EXPECT_NEAR(session.firmware(0).feedback().omega_wheel_rad_s[i], truth.omega_wheel_rad_s[i], 0.5);
    }
  }
  EXPECT_NEAR(v_forward_m_s[0], 0.5, 0.03);
  EXPECT_NEAR(v_forward_m_s[1], v_forward_m_s[0], 0.002);  // a count's place differs, nothing else
}

TEST(SessionTest, CountsGainSetsThatTheFirmwareRefuses) {
  const SessionSetup setup = setup_of("roboteam_2024", "roboteam-rem-v8", {0});
  Probes probes;
  Session session(session_config(setup), probes.maker(10 * kMs));
  Bytes out;
  session.step(encoded("roboteam-rem-v8", "REM_RobotSetPIDGains",
                       {{"toRobotId", 0}, {"toColor", 1}, {"fromPC", 1}, {"Pwheels", 1.0}}),
               out);
  for (int k = 0; k < 50; ++k) session.step({}, out);
  EXPECT_EQ(session.gains_refused(), 1u);
}

TEST(SessionTest, NamesEveryProblemOfItsConfigurationAtOnce) {
  SessionConfig config = session_config(setup_of("omni_default", "ulaval-hermes", {0}));
  config.radio_format = "ulaval-hermess";
  config.robot_ids = {3, 3, 16};
  config.plant.mechanical_step_ns = kMs;
  config.step_ns = 1'500'000;
  Probes probes;
  const std::string problems = problems_of(config, probes.maker(10 * kMs));
  for (const char* words : {"did you mean ulaval-hermes?", "1 models for 3 robot ids", "id 3 after 3",
                            "id 16", "multiple of the mechanical step"}) {
    EXPECT_NE(problems.find(words), std::string::npos) << words << " in:\n" << problems;
  }
}

TEST(SessionTest, RefusesSeveralRobotsWherePacketsNameNone) {
  const auto problems_with = [](const std::string& radio, const std::vector<int>& ids) -> std::string {
    try {
      session_config(setup_of("omni_default", radio, ids));
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return {};
  };
  EXPECT_NE(problems_with("ibis-robot-command-v2", {0, 1}).find("one wire, one robot"), std::string::npos);
  EXPECT_EQ(problems_with("ibis-robot-command-v2", {1}), "");
  EXPECT_EQ(problems_with("rocos-serial-25", {0, 1}), "") << "bits name its robots";
}

TEST(SessionTest, RefusesAControlPeriodThatIsNoMultipleOfTheMechanicalStep) {
  SessionConfig config = session_config(setup_of("omni_default", "ulaval-hermes", {0}));
  config.plant.mechanical_step_ns = kMs;
  Probes probes;
  const std::string problems = problems_of(config, probes.maker(1'250'000));
  EXPECT_NE(problems.find("control period 1250000 ns"), std::string::npos) << problems;
}

// The same bytes at the same times, twice, each in a session of its own.
TEST(SessionDeterminismTest, SameBytesAtTheSameTimesGiveTheSameAnswersAndStates) {
  struct Case {
    const char *robot, *radio, *message;
    std::vector<std::pair<std::string, double>> fields;
  };
  const std::vector<Case> cases{
      {"omni_default", "ulaval-hermes", "SPEED_MOVE", {{"robot", 1}, {"vx", 0.8}, {"vtheta", 1.0}}},
      {"roboteam_2024",
       "roboteam-rem-v8",
       "REM_RobotCommand",
       {{"toRobotId", 1},
        {"toColor", 1},
        {"fromPC", 1},
        {"rho", 0.8},
        {"theta", 0.3},
        {"sendStateInfo", 1}}}};
  for (const Case& c : cases) {
    for (const Physics physics : {Physics::kPlanar, Physics::kSimbody}) {
      Bytes answers[2];
      std::vector<std::uint8_t> states[2];
      for (int run = 0; run < 2; ++run) {
        SessionSetup setup = setup_of(c.robot, c.radio, {0, 1});
        setup.plant.physics = physics;
        Session session(session_config(setup), make_reference_firmware);
        const Bytes command = encoded(c.radio, c.message, c.fields);
        for (int k = 0; k < 600; ++k) {
          const bool write = k % 33 == 0;
          const Bytes garbage(static_cast<std::size_t>(k % 7), static_cast<std::uint8_t>(k));
          session.step(write ? command : k % 100 == 50 ? garbage : Bytes{}, answers[run]);
          if (k == 400) session.host_closed();
        }
        states[run] = session.plant().save();
      }
      EXPECT_EQ(answers[0], answers[1]);
      EXPECT_EQ(states[0], states[1]);
      if (std::string(c.radio) == "roboteam-rem-v8") {
        EXPECT_GT(answers[0].size(), 500u);
      }
    }
  }
}

TEST(SessionSetupTest, ARecordingsHeaderGivesTheSameSessionBack) {
  SessionSetup setup = setup_of("roboteam_2024", "roboteam-rem-v8", {0, 3});
  setup.team = Team::kYellow;
  setup.plant.seed = 77;
  setup.step_ns = 2 * kMs;
  setup.epoch_ms = 1234;
  const SessionSetup again = session_setup(recording_header(setup, "commit"));
  const SessionConfig a = session_config(setup), b = session_config(again);
  EXPECT_EQ(a.radio_format, b.radio_format);
  EXPECT_EQ(a.robot_ids, b.robot_ids);
  EXPECT_EQ(a.team, b.team);
  EXPECT_EQ(a.step_ns, b.step_ns);
  EXPECT_EQ(a.epoch_ms, b.epoch_ms);
  EXPECT_EQ(a.plant.seed, b.plant.seed);
  EXPECT_EQ(a.plant.physics, b.plant.physics);
  EXPECT_EQ(a.robots[1].mass_kg, b.robots[1].mass_kg);
  EXPECT_EQ(a.robots[1].motor.resistance_ohm, b.robots[1].motor.resistance_ohm);
}

TEST(RobotListTest, UnderstandsIdsRangesAndMixtures) {
  std::vector<std::string> problems;
  EXPECT_EQ(parse_robot_list("0-5", problems), (std::vector<int>{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(parse_robot_list("7,0,2", problems), (std::vector<int>{0, 2, 7}));
  EXPECT_EQ(parse_robot_list("0-2,15", problems), (std::vector<int>{0, 1, 2, 15}));
  EXPECT_TRUE(problems.empty());
}

TEST(RobotListTest, NamesEachPartItDoesNotUnderstand) {
  for (const char* bad : {"", "x", "5-2", "16", "-1", "1,,2", "1-", "0 1", "0,0", "0-3,2", "1-2-3"}) {
    std::vector<std::string> problems;
    parse_robot_list(bad, problems);
    EXPECT_EQ(problems.size(), 1u) << bad;
  }
}

}  // namespace
}  // namespace omnihil
