#include "hil/scenario/chip_fuzz.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "hil/loop/session_checks.h"
#include "hil/scenario/scenario_rows.h"

namespace omnihil {
namespace {

constexpr std::int64_t kMillisecond_ns = 1'000'000;
constexpr int kMostRuns = 80;  // of making one case smaller: a choice, halving ends after ten

bool lasts(ChipFaultKind kind) {
  return kind == ChipFaultKind::kClockOff || kind == ChipFaultKind::kInterruptStorm ||
         kind == ChipFaultKind::kWatchdogLate;
}

// The fault as a step of a scenario.
std::string step_text(const ChipFault& f) {
  std::string text = fmt::format("\n[[step]]\nat_s = {:.9f}\ndo = \"{}\"\n",
                                 static_cast<double>(f.at_ns) * 1e-9, chip_fault_word(f.kind));
  if (f.until_ns > 0)
    text += fmt::format("for_s = {:.9f}\n", static_cast<double>(f.until_ns - f.at_ns) * 1e-9);
  if (f.board > 0) text += fmt::format("board = {}\n", f.board);
  switch (f.kind) {
    case ChipFaultKind::kRamBit:
    case ChipFaultKind::kFlashBit:
      return text + fmt::format("address = 0x{:08x}\nbit = {}\n", f.address, f.bit);
    case ChipFaultKind::kRegisterBit:
      return text + fmt::format("register = {}\nbit = {}\n", f.reg, f.bit);
    case ChipFaultKind::kClockOff:
    case ChipFaultKind::kWatchdogLate:
      return text + fmt::format("ratio = {:#}\n", f.ratio);
    case ChipFaultKind::kInterruptStorm:
      return text + fmt::format("irq = {}\nrate_Hz = {:#}\n", f.irq, f.rate_Hz);
    default:
      return text;
  }
}

class Fuzzer {
 public:
  Fuzzer(const Scenario& scenario, const SuiteOptions& suite, const FuzzOptions& options)
      : base_(scenario), suite_(suite), options_(options), kinds_(options.kinds) {
    for (int k = 0; options.kinds.empty() && k < kChipFaultKinds; ++k)
      kinds_.push_back(static_cast<ChipFaultKind>(k));
    prepare();
  }

  FuzzOutcome run(const std::function<void(int)>& progress) {
    outcome_.cases = options_.cases;
    for (int number = 0; number < options_.cases; ++number) {
      std::mt19937_64 random(options_.seed * 1'000'003 + static_cast<std::uint64_t>(number));
      std::vector<ChipFault> faults(1 + random() % static_cast<std::uint64_t>(options_.most));
      for (ChipFault& fault : faults) fault = draw(random);
      if (std::string why = failure_of(faults); !why.empty()) keep(number, faults, why);
      if (progress) progress(number + 1);
    }
    return std::move(outcome_);
  }

 private:
  // From the first command to the silence; and what of the chip is in use, by a run without faults.
  void prepare() {
    std::vector<std::string> problems;
    const ScenarioStep *command = nullptr, *silence = nullptr;
    for (const ScenarioStep& step : base_.steps) {
      if (step.kind == StepKind::kCommand && command == nullptr) command = &step;
      if (step.kind == StepKind::kRadioSilence && silence == nullptr) silence = &step;
    }
    if (command == nullptr || silence == nullptr || command->at_s >= silence->at_s)
      throw_problems({fmt::format("{}: needed: a command, and radio_silence after it", base_.file)});
    from_ns_ = std::llround(command->at_s * 1e9);
    to_ns_ = std::llround(silence->at_s * 1e9);
    base_.goes_on = true;
    base_.checks.clear();
    ScenarioCheck check;
    check.kind = CheckKind::kStopsSafely;
    check.from_s = silence->at_s;
    check.to_s = silence->until_s;
    check.wheels.fill(true);
    check.at_most = options_.within_s;
    base_.checks.push_back(check);
    if (check.to_s - check.from_s <= options_.within_s)
      throw_problems({fmt::format("{}: the silence is over after {:g} s; needed: more than {:g} s",
                                  base_.file, check.to_s - check.from_s, options_.within_s)});
    const std::string why = failure_of({});
    if (!why.empty()) throw_problems({fmt::format("{}: fails without a fault: {}", base_.file, why)});
    if (seen_.flash_in_use.empty())
      throw_problems({"faults of a chip: needed: an image on an emulated ARM board"});
  }

  std::string failure_of(const std::vector<ChipFault>& faults) {
    Scenario scenario = base_;
    for (const ChipFault& fault : faults) {
      ScenarioStep step;
      step.kind = StepKind::kChip;
      step.at_s = static_cast<double>(fault.at_ns) * 1e-9;
      step.until_s = scenario.duration_s;
      step.chip = fault;
      scenario.steps.push_back(step);
    }
    ++outcome_.runs;
    const ScenarioRun run = run_of(scenario, suite_);
    if (faults.empty()) seen_ = run;
    for (const CheckResult& r : check_scenario(scenario, run)) {
      if (!r.passed) return failure_line(r);
    }
    return {};
  }

  std::uint32_t address_in(const std::vector<ChipMemoryRange>& ranges, std::mt19937_64& random) const {
    std::uint64_t all = 0;
    for (const ChipMemoryRange& range : ranges) all += range.bytes;
    std::uint64_t at = all > 0 ? random() % all : 0;
    for (const ChipMemoryRange& range : ranges) {
      if (at < range.bytes) return range.begin + static_cast<std::uint32_t>(at);
      at -= range.bytes;
    }
    return 0;
  }

  ChipFault draw(std::mt19937_64& random) const {
    ChipFault f;
    f.kind = kinds_[random() % kinds_.size()];
    f.at_ns = from_ns_ + static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(to_ns_ - from_ns_));
    if (lasts(f.kind)) {
      const std::int64_t room_ns = to_ns_ - f.at_ns;
      f.until_ns = f.at_ns + 1 + static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(room_ns));
    }
    switch (f.kind) {
      case ChipFaultKind::kRamBit:
        f.address = address_in(seen_.ram_in_use, random);
        f.bit = static_cast<std::uint32_t>(random() % 8);
        break;
      case ChipFaultKind::kFlashBit:
        f.address = address_in(seen_.flash_in_use, random);
        f.bit = static_cast<std::uint32_t>(random() % 8);
        break;
      case ChipFaultKind::kRegisterBit:
        f.reg = static_cast<std::uint32_t>(random() % 15);
        f.bit = static_cast<std::uint32_t>(random() % 32);
        break;
      case ChipFaultKind::kClockOff:  // what a crystal that does not start leaves: an RC oscillator, 1 % off
        f.ratio = random() % 2 == 0 ? 0.99 : 1.01;
        break;
      case ChipFaultKind::
          kWatchdogLate:  // the LSI is 17 to 47 kHz where 32 are said (STM32F405 data sheet, table 35)
        f.ratio = 0.5;
        break;
      case ChipFaultKind::kInterruptStorm:
        f.irq = seen_.interrupts_in_use.empty()
                    ? 0
                    : seen_.interrupts_in_use[random() % seen_.interrupts_in_use.size()];
        f.rate_Hz = 1e3 * std::pow(10.0, static_cast<double>(random() % 3));  // 1, 10 or 100 kHz
        break;
      default:
        break;
    }
    return f;
  }

  // `smaller` in the place of `faults` if it still fails.
  bool take(std::vector<ChipFault>& faults, std::string& why, std::vector<ChipFault> smaller, int& left) {
    if (left-- <= 0) return false;
    const std::string still = failure_of(smaller);
    if (still.empty()) return false;
    faults = std::move(smaller);
    why = still;
    return true;
  }

  void keep(int number, std::vector<ChipFault> faults, std::string why) {
    FuzzFailure failure;
    failure.number = number;
    failure.drawn = faults;
    int left = kMostRuns;
    for (std::size_t i = 0; i < faults.size() && faults.size() > 1;) {
      std::vector<ChipFault> without = faults;
      without.erase(without.begin() + static_cast<std::ptrdiff_t>(i));
      if (!take(faults, why, without, left)) ++i;
    }
    for (std::size_t i = 0; i < faults.size(); ++i) {
      while (faults[i].until_ns - faults[i].at_ns > 2 * kMillisecond_ns) {
        std::vector<ChipFault> shorter = faults;
        shorter[i].until_ns = faults[i].at_ns + (faults[i].until_ns - faults[i].at_ns) / 2;
        if (!take(faults, why, shorter, left)) break;
      }
      std::vector<ChipFault> rounded = faults;
      rounded[i].at_ns = faults[i].at_ns / kMillisecond_ns * kMillisecond_ns;
      if (rounded[i].at_ns >= from_ns_ && rounded[i].at_ns != faults[i].at_ns)
        take(faults, why, rounded, left);
    }
    failure.faults = faults;
    failure.why = why;
    failure.file_text = "goes_on_after_failure = true\n" + base_.text;
    for (const ChipFault& fault : faults) failure.file_text += step_text(fault);
    failure.file_text +=
        fmt::format("\n[[check]]\nis = \"stops_safely\"\nat_most_s = {:#}\n", options_.within_s);
    outcome_.failures.push_back(std::move(failure));
  }

  Scenario base_;
  const SuiteOptions& suite_;
  const FuzzOptions& options_;
  std::vector<ChipFaultKind> kinds_;
  std::int64_t from_ns_ = 0, to_ns_ = 0;
  ScenarioRun seen_;
  FuzzOutcome outcome_;
};

}  // namespace

std::string fault_words(const ChipFault& f) {
  std::string text(chip_fault_word(f.kind));
  if (f.kind == ChipFaultKind::kRamBit || f.kind == ChipFaultKind::kFlashBit)
    text += fmt::format(" 0x{:08x} bit {}", f.address, f.bit);
  if (f.kind == ChipFaultKind::kRegisterBit) text += fmt::format(" r{} bit {}", f.reg, f.bit);
  if (f.kind == ChipFaultKind::kClockOff || f.kind == ChipFaultKind::kWatchdogLate)
    text += fmt::format(" {:g} times its rate", f.ratio);
  if (f.kind == ChipFaultKind::kInterruptStorm) text += fmt::format(" IRQ {} at {:g} Hz", f.irq, f.rate_Hz);
  text += fmt::format(" at {:.9g} s", static_cast<double>(f.at_ns) * 1e-9);
  if (f.until_ns > 0) text += fmt::format(" for {:.3g} s", static_cast<double>(f.until_ns - f.at_ns) * 1e-9);
  return text;
}

FuzzOutcome fuzz_scenario(const Scenario& scenario, const SuiteOptions& suite, const FuzzOptions& options,
                          const std::function<void(int)>& progress) {
  return Fuzzer(scenario, suite, options).run(progress);
}

}  // namespace omnihil
