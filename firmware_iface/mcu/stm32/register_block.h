// A block of 32-bit registers, described by a table: what is there by name, what it holds after reset, which
// bits are kept and which kept bits the model does not act on.
//
//   constexpr RegisterInfo kRegisters[] = {{0x00, "CR", 0, 0x3}, {0x04, "SR", 0x2, 0}};
//   class Thing : public RegisterBlock { Thing(System& s) : RegisterBlock("THING", s, kRegisters) {} … };
//
// An access to an offset that the table lacks reads as zero, is ignored on writing, and is reported; so is
// the first setting of a bit without effect. Narrow accesses: load() is asked for the whole word; store()
// learns which bits were written (`lanes`), since for flags and data registers merging with the old word
// would be wrong.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "firmware_iface/mcu/peripheral.h"

namespace omnihil::mcu {

struct RegisterInfo {
  std::uint16_t offset = 0;
  std::string_view name;
  std::uint32_t reset = 0;
  std::uint32_t writable = 0xFFFFFFFFu;
  std::uint32_t no_effect = 0;  // kept, read back, but nothing follows from them: reported when first set
};

class RegisterBlock : public Peripheral {
 public:
  RegisterBlock(std::string name, System& system, std::span<const RegisterInfo> registers);

  void reset() override;
  std::uint32_t read(std::uint32_t offset, unsigned bytes) override;
  void write(std::uint32_t offset, unsigned bytes, std::uint32_t value) override;
  std::uint32_t peek(std::uint32_t offset) final { return info(offset) != nullptr ? shown(offset) : 0; }
  std::span<const RegisterInfo> registers() const { return registers_; }
  // Registers change by accesses and events alone; blocks with others, or with reads that do something, say
  // so.
  Cycles stable_until(std::uint32_t) const override { return kNever; }

 protected:
  // Default: what is stored.
  virtual std::uint32_t load(std::uint32_t offset) { return value(offset); }
  // Of a block whose load() does more than to tell: the same without it.
  virtual std::uint32_t shown(std::uint32_t offset) { return load(offset); }
  // Default: kept under the mask of the table. `value` stands in place; only bits of `lanes` were written.
  virtual void store(std::uint32_t offset, std::uint32_t value, std::uint32_t lanes) {
    keep(offset, value, lanes);
  }

  std::uint32_t& value(std::uint32_t offset) { return values_[offset >> 2]; }
  std::uint32_t value(std::uint32_t offset) const { return values_[offset >> 2]; }
  void keep(std::uint32_t offset, std::uint32_t value, std::uint32_t lanes);
  System& system() const { return system_; }
  Cycles now() const { return system_.now(); }

 private:
  const RegisterInfo* info(std::uint32_t offset) const;
  // Narrow, of a register that is not there, or of a bit without effect.
  void write_checked(std::uint32_t offset, unsigned bytes, std::uint32_t value);
  void report(std::uint32_t offset, const char* what);
  void report_no_effect(const RegisterInfo& info, std::uint32_t bits);

  System& system_;
  std::span<const RegisterInfo> registers_;
  std::vector<std::uint32_t> values_;
  std::vector<const RegisterInfo*> rows_;  // by offset / 4; null where the table has none
};

inline bool bit(std::uint32_t word, unsigned at) { return (word >> at & 1u) != 0; }
inline std::uint32_t field(std::uint32_t word, unsigned at, unsigned width) {
  return word >> at & ((1u << width) - 1u);
}

}  // namespace omnihil::mcu
