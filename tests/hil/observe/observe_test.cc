// What an image does, told from outside: coverage, profile and traces, each held to what the machine or the image itself counts.
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "hil/observe/image_profile.h"
#include "hil/observe/image_trace.h"
#include "hil/observe/profile_text.h"
#include "tests/hil/observe/image_program.h"

namespace omnihil {
namespace {

namespace fs = std::filesystem;

constexpr int kControl = 16 + 54;  // TIM6 of the STM32F405 (RM0090, table 61)

class Observe : public testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(kReferenceImage)) GTEST_SKIP() << "arm-none-eabi-gcc is not installed";
  }
};

std::vector<DebugLine> lines_of_image() {
  const std::string text = bytes_text(kReferenceImage);
  return read_lines({text.begin(), text.end()});
}

// The loop that looks gives the same run as the one that does not: instructions, time, registers, interrupts.
TEST_F(Observe, AnObservedRunIsTheSameRun) {
  ObservedImage plain, watched;
  ImageProfile profile;
  profile.begins(*watched.firmware, watched.elf, 0);
  plain.run_ms(200);
  watched.run_ms(200);
  const mcu::MachineReport a = plain.machine().report(), b = watched.machine().report();
  EXPECT_EQ(a.instructions, b.instructions);
  EXPECT_EQ(a.thread_cycles, b.thread_cycles);
  EXPECT_EQ(a.sleep_cycles, b.sleep_cycles);
  EXPECT_EQ(a.exceptions.at(kControl).busy, b.exceptions.at(kControl).busy);
  EXPECT_EQ(plain.machine().now(), watched.machine().now());
  EXPECT_TRUE(plain.machine().cpu().reg == watched.machine().cpu().reg);
  profile.ends(*watched.firmware);
}

// Every cycle of the run belongs to a function or to sleep; every control period is one call of board_tick().
TEST_F(Observe, CyclesAndCallsAddUpToWhatTheMachineCounted) {
  ObservedImage run;
  ImageProfile profile;
  profile.begins(*run.firmware, run.elf, 0);
  run.run_ms(300);
  profile.ends(*run.firmware);
  const mcu::MachineReport report = run.machine().report();
  std::int64_t all = profile.asleep();
  for (const auto& [name, cost] : profile.functions()) all += cost.self;
  EXPECT_NEAR(static_cast<double>(all) / mcu::kSubcycles, static_cast<double>(run.machine().now()), 100.0);
  EXPECT_NEAR(static_cast<double>(profile.asleep()) / mcu::kSubcycles,
              static_cast<double>(report.sleep_cycles), 0.001 * static_cast<double>(run.machine().now()));
  const mcu::InterruptLoad& control = report.exceptions.at(kControl);
  EXPECT_GE(control.count, 295u);  // 1 kHz from its start on
  EXPECT_EQ(profile.functions().at("board_tick").calls, control.count);
  EXPECT_EQ(profile.calls().at({"board_tick", "board_encoders_read"}).calls, control.count);
  EXPECT_EQ(profile.interrupts().at(kControl).count, control.count);
  EXPECT_NEAR(static_cast<double>(profile.interrupts().at(kControl).longest) / mcu::kSubcycles,
              static_cast<double>(control.longest), 1.0);
  const std::uint32_t stack = profile.interrupts().at(kControl).stack_bytes;
  EXPECT_GT(stack, 100u);
  EXPECT_LT(stack, report.main_stack_bytes);
  // What board_tick() costs with its callees is nearly all of the interrupt, and no more than it.
  const auto busy = static_cast<double>(control.busy);
  const double inclusive =
      static_cast<double>(profile.functions().at("board_tick").inclusive) / mcu::kSubcycles;
  EXPECT_LE(inclusive, busy);
  EXPECT_GT(inclusive, 0.9 * busy);
}

// lcov reads it; each figure is one that the image's own run gives.
TEST_F(Observe, CoverageIsReadByLcovAndCountsWhatRan) {
  ObservedImage first, second;
  ImageProfile profile;
  for (ObservedImage* run : {&first, &second}) {
    profile.begins(*run->firmware, run->elf, 0);
    run->run_ms(100);
    profile.ends(*run->firmware);
  }
  const std::uint64_t ticks = first.machine().report().exceptions.at(kControl).count +
                              second.machine().report().exceptions.at(kControl).count;
  const std::string info = lcov_text(profile, lines_of_image());
  EXPECT_NE(info.find("FNDA:" + std::to_string(ticks) + ",board_tick\n"), std::string::npos);
  EXPECT_NE(info.find("FNDA:2,main\n"), std::string::npos);
  EXPECT_NE(info.find("FNDA:0,fault\n"), std::string::npos);  // no fault, no run
  EXPECT_NE(info.find("/board_stm32f405/main.c\n"), std::string::npos);
  const fs::path folder = fs::temp_directory_path() / ("omnihil_observe_" + std::to_string(::getpid()));
  fs::create_directories(folder);
  std::ofstream(folder / "image.info") << info;
  if (std::system("command -v lcov >/dev/null && command -v genhtml >/dev/null") != 0) {
    fs::remove_all(folder);
    GTEST_SKIP() << "lcov is not installed";
  }
  const std::string command = "lcov --summary '" + (folder / "image.info").string() + "' >'" +
                              (folder / "said").string() +
                              "' 2>&1 && genhtml -q --ignore-errors source -o '" +
                              (folder / "html").string() + "' '" + (folder / "image.info").string() + "'";
  EXPECT_EQ(std::system(command.c_str()), 0) << bytes_text((folder / "said").string());
  EXPECT_NE(bytes_text((folder / "said").string()).find("lines"), std::string::npos);
  EXPECT_TRUE(fs::exists(folder / "html" / "index.html"));
  fs::remove_all(folder);
}

// A line's count is that of its code: a loop's body as often as it turned, a branch that was not taken not at all.
TEST_F(Observe, LinesOfALoopHaveTheCountOfItsTurns) {
  ObservedImage run;
  ImageProfile profile;
  profile.begins(*run.firmware, run.elf, 0);
  run.run_ms(50);
  profile.ends(*run.firmware);
  // board_tick() calls board_encoders_read() once: the lines of a function that never branches have one count.
  const std::uint64_t ticks = profile.functions().at("board_tick").calls;
  EXPECT_EQ(profile.functions().at("board_encoders_read").calls, ticks);
  EXPECT_EQ(profile.runs_of(*run.elf.address_of("board_encoders_read") & ~1u), ticks);
  EXPECT_EQ(profile.runs_of(*run.elf.address_of("board_motors_off") & ~1u), 0u);
}

TEST_F(Observe, CallgrindAnnotateReadsTheProfile) {
  if (std::system("command -v callgrind_annotate >/dev/null") != 0)
    GTEST_SKIP() << "valgrind is not installed";
  ObservedImage run;
  ImageProfile profile;
  profile.begins(*run.firmware, run.elf, 0);
  run.run_ms(100);
  profile.ends(*run.firmware);
  const fs::path file = fs::temp_directory_path() / ("omnihil_callgrind_" + std::to_string(::getpid()));
  std::ofstream(file) << callgrind_text(profile, lines_of_image());
  const std::string said = file.string() + ".txt";
  EXPECT_EQ(std::system(
                ("callgrind_annotate --inclusive=yes '" + file.string() + "' >'" + said + "' 2>&1").c_str()),
            0);
  EXPECT_NE(bytes_text(said).find("board_tick"), std::string::npos) << bytes_text(said);
  fs::remove(file);
  fs::remove(said);
  EXPECT_NE(profile_table(profile).find("IRQ 54"), std::string::npos) << profile_table(profile);
}

struct Nesting {
  int deepest = 0, open = 0;
  std::size_t control = 0, periods = 0;
  bool balanced = true, in_order = true;
  double first_us = 0, last_us = 0, worst_period_us = 0;
};

// An independent reader: B and E as a stack, time never backwards.
Nesting nesting_of(const std::string& json) {
  Nesting seen;
  double now_us = 0;
  bool any = false;
  const nlohmann::json trace = nlohmann::json::parse(json);
  for (const auto& event : trace["traceEvents"]) {
    const std::string phase = event["ph"];
    if (phase == "M") continue;
    const double at_us = event["ts"];
    if (!any) seen.first_us = at_us;
    any = true;
    seen.in_order = seen.in_order && at_us >= now_us;
    seen.last_us = now_us = at_us;
    if (phase == "B") {
      ++seen.open;
      seen.control += event["name"] == "IRQ 54";
    }
    if (phase == "E") --seen.open;
    seen.balanced = seen.balanced && seen.open >= 0;
    seen.deepest = std::max(seen.deepest, seen.open);
    if (phase == "C" && event["name"] == "control period") {
      ++seen.periods;
      const double off_us = std::abs(double(event["args"]["us"]) - 1000.0);
      seen.worst_period_us = std::max(seen.worst_period_us, off_us);
    }
  }
  return seen;
}

TEST_F(Observe, ATraceNestsAndHasEveryInterrupt) {
  ObservedImage run;
  ImageTrace trace({});
  trace.begins(*run.firmware, run.elf, 3);
  run.run_ms(100);
  trace.ends(*run.firmware);
  const Nesting seen = nesting_of(trace.text());
  EXPECT_TRUE(seen.balanced);
  EXPECT_TRUE(seen.in_order);
  EXPECT_EQ(seen.open, 0);
  EXPECT_GT(seen.deepest, 4);
  const std::size_t count = run.machine().report().exceptions.at(kControl).count;
  EXPECT_EQ(seen.control, count);
  EXPECT_EQ(seen.periods, count - 1);
  EXPECT_LT(seen.worst_period_us, 2.0);  // the timer's 1 ms, entered between two instructions
}

// The last 20 ms alone, what is open at their begin included.
TEST_F(Observe, OnlyTheLastStretchIsKept) {
  ObservedImage run;
  ImageTrace trace({.last_s = 0.02});
  trace.begins(*run.firmware, run.elf, 0);
  run.run_ms(200);
  trace.ends(*run.firmware);
  const Nesting seen = nesting_of(trace.text());
  EXPECT_TRUE(seen.balanced);
  EXPECT_EQ(seen.open, 0);
  EXPECT_NEAR(seen.last_us - seen.first_us, 20'000, 1'500);
  EXPECT_NEAR(static_cast<double>(seen.control), 20, 2);
}

TEST_F(Observe, AFilterKeepsItsFunctionsAndAllInterrupts) {
  ObservedImage run;
  ImageTrace trace({.last_s = 0.0, .filter = "board_tick"});
  trace.begins(*run.firmware, run.elf, 0);
  run.run_ms(50);
  trace.ends(*run.firmware);
  const std::string json = trace.text();
  EXPECT_TRUE(nesting_of(json).balanced);
  EXPECT_NE(json.find("board_tick"), std::string::npos);
  EXPECT_EQ(json.find("board_encoders_read"), std::string::npos);
  EXPECT_EQ(nesting_of(json).control, run.machine().report().exceptions.at(kControl).count);
}

// Each task has a thread of its own, in which only its own functions stand; when it runs again it is where it was.
TEST_F(Observe, TasksOfAnRtosAreThreads) {
  ObservedImage run(OMNIHIL_BUILD_DIR "/images/tasks.elf");
  ImageTrace trace({});
  trace.begins(*run.firmware, run.elf, 3);
  run.run_ms(100);
  trace.ends(*run.firmware);
  const auto number = [&run](const char* variable) {
    return run.machine().bus_read(run.elf.address_of(variable).value(), 4);
  };
  struct Thread {
    int open = 0;
    bool balanced = true;
    std::map<std::string, std::uint32_t> begun;
  };
  std::map<int, std::string> names;
  std::map<std::string, Thread> threads;
  std::set<std::string> stacks;
  const nlohmann::json read = nlohmann::json::parse(trace.text());
  for (const auto& event : read["traceEvents"])
    if (event.value("name", "") == "thread_name") names[event["tid"]] = event["args"]["name"];
  for (const auto& event : read["traceEvents"]) {
    Thread& thread = threads[names.at(event["tid"])];
    if (event["ph"] == "B") ++thread.begun[event["name"]];
    if (event["ph"] == "C") stacks.insert(event["name"]);
    thread.open += event["ph"] == "B" ? 1 : event["ph"] == "E" ? -1 : 0;
    thread.balanced = thread.balanced && thread.open >= 0;
  }
  EXPECT_EQ(threads.size(), 3u);  // and what came before the first of them
  const Thread &control = threads["board 0 control"], &blink = threads["board 0 blink"];
  EXPECT_TRUE(control.balanced && blink.balanced);
  EXPECT_EQ(control.open + blink.open, 0);
  EXPECT_NEAR(control.begun.at("control_step"), number("controls"), 1);
  EXPECT_NEAR(control.begun.at("give_way"), 2.0 * number("controls"), 3);  // and again when it is back in it
  EXPECT_EQ(control.begun.count("blink_step"), 0u);
  EXPECT_EQ(blink.begun.count("control_step"), 0u);
  EXPECT_GE(blink.begun.at("blink_step"), number("blinks"));
  // It is preempted in blink_step, which blink has called: it is back in both.
  EXPECT_NEAR(blink.begun.at("blink"), number("switches") / 2.0, 2.0);
  EXPECT_NEAR(blink.begun.at("SysTick"), 99, 2);
  EXPECT_EQ(control.begun.at("PendSV") + blink.begun.at("PendSV"), number("switches"));
  for (const char* stack : {"stack control", "stack blink", "stack interrupts"})
    EXPECT_TRUE(stacks.contains(stack)) << stack;
}

class ObserveProgram : public ImageProgram {};

TEST_F(ObserveProgram, ASuiteGivesCoverageAndProfile) {
  const Ran ran =
      run_omnihil("scenario run wheel/direction wheel/control_period --no-plots" + image() + "--coverage" +
                  shell(folder_ / "a.info") + "--profile" + shell(folder_ / "a.callgrind"));
  EXPECT_EQ(ran.exit_code, 0) << ran.text;
  EXPECT_TRUE(ran.says("reference_tick")) << ran.text;  // of the twenty that cost most
  EXPECT_TRUE(ran.says("IRQ 54")) << ran.text;
  EXPECT_NE(text_of(folder_ / "a.callgrind").find("fn=board_tick\n"), std::string::npos);
  EXPECT_NE(text_of(folder_ / "a.info").find("FNDA:2,main"), std::string::npos);
  EXPECT_NE(text_of(folder_ / "a.callgrind").find("events: Cycles"), std::string::npos);
}

// The last stretch is written when a check fails, and only then.
TEST_F(ObserveProgram, TheLastStretchIsWrittenWhenACheckFails) {
  const std::string last = "--trace" + shell(folder_ / "t.json") + "--trace-last 0.05 ";
  const Ran good = run_omnihil("scenario run wheel/direction --no-plots" + image() + last);
  EXPECT_EQ(good.exit_code, 0) << good.text;
  EXPECT_FALSE(fs::exists(folder_ / "t.json"));
  std::ofstream(folder_ / "fails.toml")
      << "format = \"omnihil-scenario/1\"\ntitle = \"fails\"\nduration_s = 0.3\n"
         "[[step]]\nat_s = 0.1\ndo = \"command\"\nv_forward_m_s = 1.0\n"
         "[[check]]\nis = \"signal\"\nsignal = \"v_forward_m_s\"\nat_most_m_s = -1\n";
  const Ran bad =
      run_omnihil("scenario run" + shell(folder_ / "fails.toml") + " --no-plots" + image() + last);
  EXPECT_EQ(bad.exit_code, 1) << bad.text;
  const Nesting seen = nesting_of(text_of(folder_ / "t.json"));
  EXPECT_TRUE(seen.balanced);
  EXPECT_NEAR(seen.last_us, 300'000, 1'500);
  EXPECT_NEAR(seen.last_us - seen.first_us, 50'000, 2'000);
  EXPECT_EQ(run_omnihil("scenario run wheel/direction --trace-last 1").exit_code, 2);
  EXPECT_EQ(run_omnihil("scenario run wheel/direction --trace t.txt").exit_code, 2);
}

}  // namespace
}  // namespace omnihil
