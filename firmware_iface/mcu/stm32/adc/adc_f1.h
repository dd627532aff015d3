// ADC registers of F1 (RM0008 §11): each converter alone with its registers; ADC1's CR1 says how ADC2 goes with it.
//
//   AdcF1 adc1({.number = 1, .irq = 18, .dma = true}, triggers, nullptr, context);
//   AdcF1 adc2({.number = 2, .irq = 18}, triggers, &adc1, context);      // its slave in dual modes
//
// Law: as adc.h; a conversion takes 12.5 clocks of PCLK2 over ADCPRE. EOC is set at the end of either sequence, by ADON
// written again a conversion starts. Dual modes as adc_together.h, the pair's results as one word in ADC1's DR.
#pragma once
#include "firmware_iface/mcu/stm32/adc/adc_status.h"

namespace omnihil::mcu {

struct AdcF1Spec {
  int number = 1, irq = 18;
  bool dma = false;
};

class AdcF1 final : public AdcWithStatus {
 public:
  AdcF1(const AdcF1Spec& spec, const AdcTriggers& triggers, AdcF1* master, ChipContext& context);
  void reset() override;

 protected:
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override;
  unsigned length(Group group) const override;
  double convert_clocks() const override { return 12.5; }
  double clock_hz() const override { return context().clocks.bus_hz(Bus::kAdc); }
  unsigned bits() const override { return 12; }
  void result(Group group, unsigned place, std::uint32_t code, bool last) override;
  std::pair<int, unsigned> trigger(Group group) const override;
  void ordered(std::uint32_t before, std::uint32_t written) override;
  void update() override;

 private:
  std::size_t deliver(std::span<const std::uint32_t> results);
  AdcTogether pair_;
  IrqLine irq_;
  int dma_;  // below 0: none
};

}  // namespace omnihil::mcu
