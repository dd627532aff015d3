// ADC registers of F3, G4, H7 and L4 (RM0316 §15, RM0440 §21, RM0433 §25, RM0351 §18), and of F0 (RM0091 §13), which has them
// without injected ones, as G0 (RM0444 §15). H7: as revision V of the chip, which halves the clock; 16 bits.
//
//   AdcV2 adc("ADC1", AdcFamily::kF3, irq, triggers, context);
//
// The common block of a pair (clock prescaler, dual status) is at offset 0x300 of the first of them:
// AdcV2Common.
#pragma once
#include "firmware_iface/mcu/stm32/adc/adc.h"

namespace omnihil::mcu {

enum class AdcFamily : std::uint8_t { kF0, kF3, kG0, kG4, kH7, kL4 };

class AdcV2 final : public Adc {
 public:
  AdcV2(const std::string& name, AdcFamily family, int irq, const AdcTriggers& triggers,
        ChipContext& context);
  void reset() override;
  Cycles stable_until(std::uint32_t offset) const override { return (offset & ~3u) == 0x40 ? 0 : kNever; }
  std::uint32_t status() const { return value(0); }
  // CKMODE and PRESC of the common block.
  void set_common(std::uint32_t ccr) {
    registers_change();
    ccr_ = ccr;
  }
  void data_was_read();  // by the common data register

 protected:
  std::uint32_t load(std::uint32_t offset) override;
  std::uint32_t shown(std::uint32_t offset) override;
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override;
  unsigned length(Group group) const override;
  unsigned channel(Group group, unsigned place) const override;
  double sample_clocks(unsigned channel) const override;
  double convert_clocks() const override { return (family_ == AdcFamily::kH7 ? bits() / 2 : bits()) + 0.5; }
  double clock_hz() const override;
  unsigned bits() const override;
  bool left_aligned() const override;
  void result(Group group, unsigned place, std::uint32_t code, bool last) override;
  bool continues() const override { return bit(value(0x0C), 13); }
  bool one_per_trigger() const override { return bit(value(0x0C), 16); }
  bool injected_follow() const override { return !regular_alone() && bit(value(0x0C), 25); }
  std::pair<int, unsigned> trigger(Group group) const override;
  bool armed(Group group) const override;
  bool enabled() const override { return bit(value(0x08), 0); }

 private:
  void control(std::uint32_t written);
  bool regular_alone() const { return family_ == AdcFamily::kF0 || family_ == AdcFamily::kG0; }
  bool places_chosen() const { return family_ == AdcFamily::kG0 && bit(value(0x0C), 21); }  // CHSELRMOD
  bool old_fields() const { return family_ == AdcFamily::kF3 || family_ == AdcFamily::kL4; }
  void update();
  void count_selected();  // after every change of CHSELR
  AdcFamily family_;
  IrqLine irq_;
  int dma_;
  std::uint32_t ccr_ = 0;
  unsigned selected_ = 0;  // channels
};

class AdcV2Common final : public RegisterBlock {
 public:
  AdcV2Common(const std::string& name, std::vector<AdcV2*> adcs, ChipContext& context);
  void reset() override;
  Cycles stable_until(std::uint32_t offset) const override { return (offset & ~3u) == 0x0C ? 0 : kNever; }

 protected:
  std::uint32_t load(std::uint32_t offset) override;
  std::uint32_t shown(std::uint32_t offset) override;
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override;

 private:
  std::size_t deliver(std::span<const std::uint32_t> results);
  ChipContext& context_;
  std::vector<AdcV2*> adcs_;
  AdcTogether group_;
  int dma_;
};

}  // namespace omnihil::mcu
