// ADC registers of F4 and F7 (RM0090 §13), and the block common to the three of them.
//
//   AdcV1Common common(context);
//   AdcV1 adc(1, irq, common, triggers, context);
#pragma once
#include "firmware_iface/mcu/stm32/adc/adc_status.h"

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

class AdcV1 final : public AdcWithStatus {
 public:
  AdcV1(int number, int irq, AdcV1Common& common, const AdcTriggers& triggers, ChipContext& context);

 protected:
  double convert_clocks() const override { return bits(); }
  double clock_hz() const override { return common_.clock_hz(); }
  unsigned bits() const override;
  void result(Group group, unsigned place, std::uint32_t code, bool last) override;
  std::pair<int, unsigned> trigger(Group group) const override;
  void ordered(std::uint32_t before, std::uint32_t written) override;
  void update() override;

 private:
  AdcV1Common& common_;
  unsigned number_;
  IrqLine irq_;
  int dma_;
};

}  // namespace omnihil::mcu
