// What the ADC registers of F1 (adc_f1.h) and of F4 and F7 (adc_v1.h) have alike: a status register of flags that are cleared by
// writing zeros, CR1, CR2, sequences from SQR3 and JSQ4 on, sample times.
//
//   class AdcF1 final : public AdcWithStatus { … };
//
// Law: RM0008 §11.12, RM0090 §13.13.
#pragma once
#include <span>
#include <string>

#include "firmware_iface/mcu/stm32/adc/adc.h"

namespace omnihil::mcu {

class AdcWithStatus : public Adc {
 public:
  void reset() override;
  Cycles stable_until(std::uint32_t offset) const override { return (offset & ~3u) == kDr ? 0 : kNever; }
  void data_was_read();

 protected:
  enum : std::uint16_t {
    kSr = 0x00,
    kCr1 = 0x04,
    kCr2 = 0x08,
    kSmpr1 = 0x0C,
    kSmpr2 = 0x10,
    kSqr1 = 0x2C,
    kSqr3 = 0x34,
    kJsqr = 0x38,
    kJdr1 = 0x3C,
    kDr = 0x4C
  };
  static constexpr std::uint32_t kEoc = 1u << 1, kJeoc = 1u << 2, kJstrt = 1u << 3, kStrt = 1u << 4;  // SR

  struct Kind {
    std::span<const RegisterInfo> registers;
    std::span<const double, 8> sample_clocks;  // by the code of a channel in SMPRx
    std::uint32_t orders = 0;                  // of CR2: carried out and cleared at once
  };
  AdcWithStatus(const std::string& name, const Kind& kind, const AdcTriggers& triggers, ChipContext& context)
      : Adc(name, kind.registers, triggers, context), kind_(kind) {}
  virtual void update() = 0;  // the interrupt
  // CR2 was written while it is on: starts what is asked for.
  virtual void ordered(std::uint32_t before, std::uint32_t written) = 0;

  std::uint32_t load(std::uint32_t offset) override;
  std::uint32_t shown(std::uint32_t offset) override { return value(offset); }
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override;
  unsigned length(Group group) const override;
  unsigned channel(Group group, unsigned place) const override;
  double sample_clocks(unsigned channel) const override;
  bool left_aligned() const override { return bit(value(kCr2), 11); }
  bool continues() const override { return bit(value(kCr2), 1); }
  bool one_per_trigger() const override { return bit(value(kCr1), 11); }
  bool injected_follow() const override { return bit(value(kCr1), 10); }
  bool armed(Group) const override { return enabled(); }
  bool enabled() const override { return bit(value(kCr2), 0); }
  bool by_dma() const { return bit(value(kCr2), 8); }
  void start_with(Group group, std::uint32_t flag) {
    value(kSr) |= flag;
    start(group);
  }
  // Of EOC and JEOC.
  bool asks() const {
    const std::uint32_t sr = value(kSr), cr1 = value(kCr1);
    return ((sr & kEoc) != 0 && bit(cr1, 5)) || ((sr & kJeoc) != 0 && bit(cr1, 7));
  }

 private:
  Kind kind_;
};

}  // namespace omnihil::mcu
