// ADC registers of F4 and F7 (RM0090 §13), and the block common to the three of them.
//
//   AdcV1Common common(context);
//   AdcV1 adc(1, irq, common, triggers, context);
#pragma once
#include "firmware_iface/mcu/stm32/adc/adc.h"

namespace omnihil::mcu {

class AdcV1;

class AdcV1Common final : public RegisterBlock {
 public:
  explicit AdcV1Common(ChipContext& context);
  void reset() override;
  Cycles stable_until(std::uint32_t offset) const override { return (offset & ~3u) == 0x08 ? 0 : kNever; }
  double clock_hz() const;
  void add(AdcV1& adc);
  void set_status(unsigned adc, std::uint32_t status);  // from 0

 protected:
  std::uint32_t load(std::uint32_t offset) override;
  std::uint32_t shown(std::uint32_t offset) override { return value(offset); }
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override;

 private:
  std::size_t deliver(std::span<const std::uint32_t> results);
  ChipContext& context_;
  AdcTogether group_;
  std::vector<AdcV1*> adcs_;
  int dma_;
};

class AdcV1 final : public Adc {
 public:
  AdcV1(int number, int irq, AdcV1Common& common, const AdcTriggers& triggers, ChipContext& context);
  void reset() override;
  Cycles stable_until(std::uint32_t offset) const override { return (offset & ~3u) == 0x4C ? 0 : kNever; }
  void data_was_read();  // by the common data register

 protected:
  std::uint32_t load(std::uint32_t offset) override;
  std::uint32_t shown(std::uint32_t offset) override { return value(offset); }
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override;
  unsigned length(Group group) const override;
  unsigned channel(Group group, unsigned place) const override;
  double sample_clocks(unsigned channel) const override;
  double convert_clocks() const override { return bits(); }
  double clock_hz() const override { return common_.clock_hz(); }
  unsigned bits() const override;
  bool left_aligned() const override;
  void result(Group group, unsigned place, std::uint32_t code, bool last) override;
  bool continues() const override;
  bool one_per_trigger() const override;
  bool injected_follow() const override;
  std::pair<int, unsigned> trigger(Group group) const override;
  bool armed(Group group) const override;
  bool enabled() const override { return bit(value(0x08), 0); }

 private:
  void update();
  AdcV1Common& common_;
  unsigned number_;
  IrqLine irq_;
  int dma_;
};

}  // namespace omnihil::mcu
