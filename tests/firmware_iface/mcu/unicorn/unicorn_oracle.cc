// The other side of the differential test: runs the same instructions in Unicorn. A program of its own,
// talked to over its standard input and output, so that nothing of Unicorn (GPL) is linked with the product.
//
//   unicorn_oracle cortex-m4f | cortex-m7 | cortex-m0
//
// Unicorn 2.0: the model is chosen before any mapping and without UC_MODE_MCLASS (which would be a
// Cortex-M33); flags go in by XPSR_NZCVQG, else GE is left out; host writes to code that was run need its
// translations removed.
#include <unicorn/unicorn.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "tests/firmware_iface/mcu/unicorn/oracle_protocol.h"

namespace omnihil::mcu {
namespace {

constexpr std::uint32_t kClearMonitor = kOracleFlash + 0x100;  // a CLREX
constexpr std::uint32_t kFirstFp = kOracleFlash + 0x200;       // VMOV.F32 S0, S0
alignas(4096) std::uint8_t flash[kOracleFlashBytes];
alignas(4096) OracleRam ram, ram_before;

uc_engine* open_engine(const char* variant) {
  uc_engine* uc = nullptr;
  if (uc_open(UC_ARCH_ARM, UC_MODE_THUMB, &uc) != UC_ERR_OK) std::exit(3);
  int model = UC_CPU_ARM_CORTEX_M4;
  if (std::strcmp(variant, "cortex-m7") == 0) model = UC_CPU_ARM_CORTEX_M7;
  if (std::strcmp(variant, "cortex-m3") == 0) model = UC_CPU_ARM_CORTEX_M3;
  if (std::strcmp(variant, "cortex-m0") == 0) model = UC_CPU_ARM_CORTEX_M0;
  if (uc_ctl_set_cpu_model(uc, model) != UC_ERR_OK) std::exit(3);
  uc_mem_map_ptr(uc, kOracleFlash, kOracleFlashBytes, UC_PROT_READ | UC_PROT_EXEC, flash);
  uc_mem_map_ptr(uc, kOracleRam, kOracleRamBytes, UC_PROT_ALL, ram.data());
  uc_emu_start(uc, kFirstFp | 1, 0, 0, 1);  // the first FP instruction makes a context and so resets FPSCR
  return uc;
}

struct Transfer {
  int ids[50];
  void* values[50];
  int count = 0;
  void add(int id, void* value) {
    ids[count] = id;
    values[count++] = value;
  }
};

Transfer common(std::uint32_t* r, std::uint32_t* s, std::uint32_t* fpscr) {
  Transfer t;
  for (int i = 0; i < 13; ++i) t.add(UC_ARM_REG_R0 + i, &r[i]);
  t.add(UC_ARM_REG_SP, &r[13]);
  t.add(UC_ARM_REG_LR, &r[14]);
  for (int i = 0; i < 32; ++i) t.add(UC_ARM_REG_S0 + i, &s[i]);
  t.add(UC_ARM_REG_FPSCR, fpscr);
  return t;
}

OracleEnd end_of(uc_err error, const std::uint16_t* code) {
  const bool wait_or_yield =
      code[0] == 0xBF20 || code[0] == 0xBF10 || (code[0] == 0xF3AF && (code[1] & 0xFF) < 3);
  switch (error) {
    case UC_ERR_OK:
      return OracleEnd::kRan;
    case UC_ERR_INSN_INVALID:
      return wait_or_yield ? OracleEnd::kRan : OracleEnd::kUndefined;
    case UC_ERR_EXCEPTION:
      return OracleEnd::kException;
    default:
      return OracleEnd::kMemory;
  }
}

OracleResult run(uc_engine* uc, OracleCase& c, std::uint32_t pc) {
  std::memcpy(ram.data(), ram_before.data(), kOracleRamBytes);
  const bool sets_monitor = (c.code[0] & 0xFF70) == 0xE850 || (c.code[0] & 0xFFF0) == 0xE8D0;
  Transfer in = common(c.r, c.s, &c.fpscr);
  std::uint32_t xpsr = 0x01000000u | c.apsr;
  in.add(UC_ARM_REG_XPSR_NZCVQG, &xpsr);
  uc_reg_write_batch(uc, in.ids, in.values, in.count);
  // Always with a count: taking it away would make Unicorn translate everything anew. A block ends in a jump
  // to itself, so too many turns do no harm.
  const uc_err error = uc_emu_start(uc, pc | 1, 0, 0, c.until ? kOracleSlotBytes : 1);
  OracleResult result{};
  Transfer out = common(result.r, result.s, &result.fpscr);
  out.add(UC_ARM_REG_PC, &result.r[15]);
  out.add(UC_ARM_REG_XPSR, &result.apsr);
  uc_reg_read_batch(uc, out.ids, out.values, out.count);
  result.apsr &= 0xF80F0000u;
  result.end = end_of(error, c.code);
  result.ram_hash = hash_oracle_ram(ram);
  if (sets_monitor) uc_emu_start(uc, kClearMonitor | 1, 0, 0, 1);
  return result;
}

int serve(const char* variant) {
  constexpr std::uint8_t kClrex[] = {0xBF, 0xF3, 0x2F, 0x8F};
  for (std::uint32_t i = 0; i < kOracleFlashBytes; i += 2) flash[i + 1] = 0xBF;  // NOP
  std::memcpy(flash + (kClearMonitor - kOracleFlash), kClrex, 4);
  constexpr std::uint8_t kVmov[] = {0xB0, 0xEE, 0x40, 0x0A};
  std::memcpy(flash + (kFirstFp - kOracleFlash), kVmov, 4);
  uc_engine* uc = open_engine(variant);
  OracleBatch batch;
  std::vector<OracleCase> cases;
  std::vector<OracleResult> results;
  while (std::fread(&batch, sizeof batch, 1, stdin) == 1) {
    cases.resize(batch.cases);
    results.clear();
    if (std::fread(cases.data(), sizeof(OracleCase), batch.cases, stdin) != batch.cases) return 1;
    fill_oracle_ram(ram_before, batch.ram_seed);
    const std::uint32_t begin = kOracleCode + batch.slot * kOracleSlotBytes;
    for (std::uint32_t i = 0; i < batch.cases; ++i) {
      std::memcpy(flash + (begin - kOracleFlash) + i * kOracleSlotBytes, cases[i].code, kOracleSlotBytes);
    }
    if (batch.slot == 0) {  // the places are used anew: nothing of their translations may stay
      uc_close(uc);
      uc = open_engine(variant);
    }
    // An earlier case may have jumped here, which had these places translated as they were then.
    uc_ctl_remove_cache(uc, begin, begin + batch.cases * kOracleSlotBytes);
    for (std::uint32_t i = 0; i < batch.cases; ++i)
      results.push_back(run(uc, cases[i], begin + i * kOracleSlotBytes));
    if (std::fwrite(results.data(), sizeof(OracleResult), results.size(), stdout) != results.size()) return 1;
    std::fflush(stdout);
  }
  uc_close(uc);
  return 0;
}

}  // namespace
}  // namespace omnihil::mcu

int main(int argc, char** argv) { return omnihil::mcu::serve(argc > 1 ? argv[1] : "cortex-m4f"); }
