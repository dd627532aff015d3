// Random instructions with random registers, flags and memory, here and in an independent emulator (its own
// program, over a pipe). Whatever both execute must leave the same state.
//
//   OMNIHIL_DIFFERENTIAL_CASES=30000000 OMNIHIL_DIFFERENTIAL_SEED=2 build/release/tests/test_firmware_iface_mcu
//   --gtest_filter='*Oracle*'
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <optional>
#include <string>

#include "firmware_iface/mcu/core/cpu.h"
#include "tests/firmware_iface/mcu/instruction_source.h"

namespace omnihil::mcu {
namespace {

class Oracle {
 public:
  explicit Oracle(const char* variant) {
    std::signal(SIGPIPE, SIG_IGN);  // its end is told by what is read from it
    int to[2], from[2];
    if (access(OMNIHIL_BUILD_DIR "/tests/firmware_iface/mcu/unicorn/unicorn_oracle", X_OK) != 0 ||
        pipe(to) != 0 || pipe(from) != 0) {
      return;
    }
    child_ = fork();
    if (child_ == 0) {
      dup2(to[0], 0);
      dup2(from[1], 1);
      for (int fd : {to[0], to[1], from[0], from[1]}) close(fd);
      execl(OMNIHIL_BUILD_DIR "/tests/firmware_iface/mcu/unicorn/unicorn_oracle", "unicorn_oracle", variant,
            nullptr);
      _exit(127);
    }
    close(to[0]);
    close(from[1]);
    in_ = fdopen(to[1], "wb");
    out_ = fdopen(from[0], "rb");
  }
  ~Oracle() {
    if (in_) fclose(in_);
    if (out_) fclose(out_);
    if (child_ > 0) waitpid(child_, nullptr, 0);
  }
  bool present() const { return child_ > 0; }
  bool ask(const OracleBatch& batch, const std::vector<OracleCase>& cases,
           std::vector<OracleResult>& results) {
    results.resize(cases.size());
    return fwrite(&batch, sizeof batch, 1, in_) == 1 &&
           fwrite(cases.data(), sizeof(OracleCase), cases.size(), in_) == cases.size() && fflush(in_) == 0 &&
           fread(results.data(), sizeof(OracleResult), results.size(), out_) == results.size();
  }

 private:
  pid_t child_ = -1;
  FILE *in_ = nullptr, *out_ = nullptr;
};

struct NoBus final : CpuBus {
  bool read(std::uint32_t, unsigned, std::uint32_t&) override { return false; }
  bool write(std::uint32_t, unsigned, std::uint32_t) override { return false; }
  void note_null(std::uint32_t, bool) override {}
  void note_unaligned(std::uint32_t) override {}
};

class Bench {
 public:
  explicit Bench(const Variant& variant) {
    memory_.add("ram", kOracleRam, kOracleRamBytes, kRam);
    memory_.add("flash", kOracleFlash, kOracleFlashBytes, kFlash);
    const std::vector<std::uint16_t> nops(kOracleFlashBytes / 2, 0xBF00);
    memory_.write(kOracleFlash, {reinterpret_cast<const std::uint8_t*>(nops.data()), kOracleFlashBytes});
    cpu_.emplace(variant, memory_, bus_);
    cpu_->fp_enabled = variant.fpu != Fpu::kNone;
  }
  void put_code(std::uint32_t pc, const std::uint16_t* code) {
    memory_.write(pc, {reinterpret_cast<const std::uint8_t*>(code), kOracleSlotBytes});
  }
  Stop run(const OracleCase& c, std::uint32_t pc, const OracleRam& before) {
    std::memcpy(memory_.regions()[0]->data(), before.data(), kOracleRamBytes);
    Registers& R = cpu_->reg;
    R = Registers{};
    std::copy_n(c.r, 15, R.r);
    R.r[15] = pc;
    R.set_apsr(cpu_->variant().arch == Arch::kV6M ? c.apsr & 0xF0000000u : c.apsr);
    std::copy_n(c.s, 32, R.s);
    R.fpscr = c.fpscr;
    R.control |= kFpContextActive;  // FPSCR is what it is
    Stop stop = cpu_->run(0, 1);
    while (stop == Stop::kDeadline && c.until != 0 && R.r[15] < pc + c.until) stop = cpu_->run(0, 1);
    return stop;
  }
  std::uint64_t ram_hash() const {
    OracleRam now;
    std::memcpy(now.data(), memory_.regions()[0]->data(), kOracleRamBytes);
    return hash_oracle_ram(now);
  }
  Cpu& cpu() { return *cpu_; }

 private:
  Memory memory_;
  NoBus bus_;
  std::optional<Cpu> cpu_;
};

// One is the smallest normal number (of either width, by its upper word), the other is 0.
bool is_smallest(std::uint32_t a, std::uint32_t b) {
  const std::uint32_t both = (a | b) & 0x7FFFFFFFu;
  return (a & b & 0x7FFFFFFFu) == 0 && (both == 0x00800000u || both == 0x00100000u);
}

std::string difference(Cpu& cpu, std::uint64_t ram_hash, const OracleResult& theirs) {
  std::string text;
  char part[64];
  const auto add = [&](const char* what, int index, std::uint32_t mine, std::uint32_t other) {
    std::snprintf(part, sizeof part, " %s%d %08x, oracle %08x;", what, index, mine, other);
    text += part;
  };
  for (int i = 0; i < 16; ++i) {
    const std::uint32_t mask = i == 15 ? ~1u : i == 13 ? ~3u : ~0u;
    if ((cpu.reg.r[i] ^ theirs.r[i]) & mask) add("r", i, cpu.reg.r[i], theirs.r[i]);
  }
  const std::uint32_t flags = cpu.variant().arch == Arch::kV6M ? 0xF0000000u : 0xF80F0000u;
  if ((cpu.reg.apsr() ^ theirs.apsr) & flags) add("apsr", 0, cpu.reg.apsr(), theirs.apsr);
  for (int i = 0; i < 32; ++i) {
    const bool smallest = cpu.reg.fpscr & kFlushToZero && is_smallest(cpu.reg.s[i], theirs.s[i]);
    if (cpu.reg.s[i] != theirs.s[i] && !smallest) add("s", i, cpu.reg.s[i], theirs.s[i]);
  }
  if ((cpu.reg.fpscr ^ theirs.fpscr) & 0xF0000000u) add("fpscr", 0, cpu.reg.fpscr, theirs.fpscr);
  if (ram_hash != theirs.ram_hash) text += " memory;";
  return text;
}

struct Tally {
  std::uint64_t drawn = 0, compared = 0, both_undefined = 0, both_memory = 0, alignment = 0, to_arm_state = 0;
  std::uint64_t too_lax = 0, different = 0, memory_there_only = 0;
  std::map<std::string, std::uint64_t> stricter, ops;
  std::string examples;
  int shown = 0;

  void show(const char* what, const OracleCase& c, const char* op, const std::string& detail) {
    if (++shown > (std::getenv("OMNIHIL_DIFFERENTIAL_SHOW") ? 100000 : 25)) return;
    char part[32];
    std::string line = std::string(what) + ":";
    for (std::uint32_t i = 0; i < (c.until ? c.until / 2 : 2); ++i) {
      std::snprintf(part, sizeof part, " %04x", c.code[i]);
      line += part;
    }
    std::snprintf(part, sizeof part, " (%s), fpscr %08x:", op, c.fpscr);
    line += part;
    examples += line + detail + "\n";
  }
};

// The group of an encoding that is refused here and executed there, coarse enough to be listed.
std::string group_of(const OracleCase& c) {
  char text[32];
  if (c.code[0] >> 11 < 29) {
    std::snprintf(text, sizeof text, "%02x..", c.code[0] >> 8);
  } else {
    std::snprintf(text, sizeof text, "%03x. %x...", c.code[0] >> 4, c.code[1] >> 12);
    if (c.code[0] >> 9 != 0x7C) std::snprintf(text, sizeof text, "%03x.", c.code[0] >> 4);
  }
  return text;
}

void judge(Bench& bench, Stop stop, std::uint32_t pc, const OracleCase& c, std::uint32_t instructions,
           const OracleResult& theirs, Tally& tally) {
  Cpu& cpu = bench.cpu();
  const Op op = decode({pc, cpu.variant(), 0}, c.code[0], c.code[1]);
  tally.drawn += instructions;
  const std::uint32_t fault = stop == Stop::kFault ? cpu.fault.status : 0;
  const bool undefined = fault & (kUndefinedInstruction | kNoCp);
  const bool ran = theirs.end == OracleEnd::kRan;
  if (fault & kInvalidState) {
    ++tally.to_arm_state;
  } else if (undefined && !ran) {
    ++tally.both_undefined;
  } else if (undefined) {
    ++tally.stricter[group_of(c)];
    if (std::getenv("OMNIHIL_DIFFERENTIAL_SHOW")) tally.show("refused", c, op_name(op.code), "");
  } else if (theirs.end == OracleEnd::kUndefined) {
    ++tally.too_lax;
    tally.show("executed here, refused there", c, op_name(op.code), "");
  } else if (fault & kUnaligned) {
    ++tally.alignment;
  } else if (fault != 0 && !ran) {
    ++tally.both_memory;
  } else if (fault != 0 || !ran) {
    // A jump to where no memory is faults at the next instruction, which the oracle looks at a little early.
    const bool jumped = cpu.reg.r[15] - pc > 4 || fault & kInstructionBus;
    if (!jumped) tally.show("memory fault on one side only", c, op_name(op.code), "");
    ++(jumped ? tally.both_memory : tally.memory_there_only);
  } else {
    tally.compared += instructions;
    ++tally.ops[op_name(op.code)];
    const std::string text = difference(cpu, bench.ram_hash(), theirs);
    if (!text.empty()) {
      ++tally.different;
      tally.show("differs", c, op_name(op.code), text);
    }
  }
}

constexpr std::uint32_t kBatch = 128,
                        kSlots = (kOracleFlashBytes - 0x3000) / kOracleSlotBytes / kBatch * kBatch;

Tally compare_with_oracle(Oracle& oracle, const Variant& variant, std::uint64_t cases, std::uint64_t seed) {
  Tally tally;
  Bench bench(variant);
  const bool narrow = variant.arch == Arch::kV6M, doubles = variant.fpu == Fpu::kDouble;
  std::vector<OracleCase> batch(kBatch);
  std::vector<std::uint32_t> instructions(kBatch);
  std::vector<OracleResult> results;
  OracleRam ram;
  std::uint32_t slot = 0;
  for (std::uint64_t done = 0; done < cases; done += kBatch, slot = (slot + kBatch) % kSlots) {
    Draw draw(oracle_mix(seed) + done * 4096);
    for (std::uint32_t i = 0; i < kBatch; ++i) {
      OracleCase& c = batch[i];
      c = OracleCase{};
      instructions[i] = 1;
      for (std::uint16_t& halfword : c.code) halfword = 0xBF00;
      if (!narrow && draw.one_in(16)) {
        c.until = draw_block(draw, c.code);
      } else if (draw.one_in(2)) {
        c.until = draw_row(draw, variant, c.code, instructions[i]);
      } else {
        draw_instruction(draw, variant, c.code);
      }
      draw_state(draw, doubles, c);
    }
    if (!oracle.ask({kBatch, slot, done}, batch, results)) {
      tally.examples += "the oracle has ended\n";
      ++tally.different;
      return tally;
    }
    fill_oracle_ram(ram, done);
    const auto place = [&](std::uint32_t i) { return kOracleCode + (slot + i) * kOracleSlotBytes; };
    for (std::uint32_t i = 0; i < kBatch; ++i) bench.put_code(place(i), batch[i].code);
    for (std::uint32_t i = 0; i < kBatch; ++i) {
      const std::uint32_t pc = place(i);
      const Stop stop = bench.run(batch[i], pc, ram);
      judge(bench, stop, pc, batch[i], instructions[i], results[i], tally);
    }
  }
  return tally;
}

void print(const char* name, const Tally& t) {
  std::uint64_t stricter = 0;
  for (const auto& [group, count] : t.stricter) stricter += count;
  std::printf(
      "%s: %llu drawn, %llu compared, %zu operations; not compared: %llu refused by both, %llu refused here "
      "alone, "
      "%llu unaligned, %llu to ARM state, %llu outside of memory on both\n",
      name, static_cast<unsigned long long>(t.drawn), static_cast<unsigned long long>(t.compared),
      t.ops.size(), static_cast<unsigned long long>(t.both_undefined),
      static_cast<unsigned long long>(stricter), static_cast<unsigned long long>(t.alignment),
      static_cast<unsigned long long>(t.to_arm_state), static_cast<unsigned long long>(t.both_memory));
  if (std::getenv("OMNIHIL_DIFFERENTIAL_SHOW")) {
    for (const auto& [group, count] : t.stricter) {
      std::printf("  refused %s %llu\n", group.c_str(), static_cast<unsigned long long>(count));
    }
  }
  std::printf("%s", t.examples.c_str());
}

class OracleTest : public ::testing::TestWithParam<const Variant*> {};

TEST_P(OracleTest, StateIsTheSameAfterWhatBothExecute) {
  const Variant& variant = *GetParam();
  Oracle oracle(variant.name.data());
  if (!oracle.present()) GTEST_SKIP() << "unicorn_oracle is not built: libunicorn-dev is not installed";
  const char* wanted = std::getenv("OMNIHIL_DIFFERENTIAL_CASES");
  const std::uint64_t cases = wanted ? std::strtoull(wanted, nullptr, 10) : 45'000;
  const char* seed = std::getenv("OMNIHIL_DIFFERENTIAL_SEED");
  const Tally tally =
      compare_with_oracle(oracle, variant, cases, seed ? std::strtoull(seed, nullptr, 10) : 1);
  print(variant.name.data(), tally);
  EXPECT_EQ(tally.different, 0u);
  EXPECT_EQ(tally.too_lax, 0u);
  EXPECT_EQ(tally.memory_there_only, 0u);
  EXPECT_GT(tally.compared, tally.drawn / 4);
}

INSTANTIATE_TEST_SUITE_P(Variants, OracleTest, ::testing::Values(&kCortexM4F, &kCortexM7, &kCortexM0),
                         [](const auto& of) {
                           std::string name(of.param->name);
                           std::erase(name, '-');
                           return name;
                         });

}  // namespace
}  // namespace omnihil::mcu
