// The chip that a board file speaks of, for its reader: which names there are.
//
//   BoardNames names(*find_chip("stm32f405"));
//   names.has_channel(*parse_channel("TIM1.3"));     // false where the chip has no such channel
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "firmware_iface/mcu/board/board_spec.h"
#include "firmware_iface/mcu/stm32/chip.h"

namespace omnihil::mcu {

std::optional<PinName> parse_pin(std::string_view text);
std::optional<ChannelName> parse_channel(std::string_view text);

class BoardNames {
 public:
  explicit BoardNames(const ChipSpec& spec);
  ~BoardNames();
  bool has_pin(const PinName& pin) const;
  bool has_channel(const ChannelName& channel) const;
  bool has_timer(const std::string& name) const;
  bool has_inputs(const std::string& name, unsigned inputs) const;  // a timer with so many
  bool has_adc(const std::string& name) const;
  bool has_spi(const std::string& name) const;
  bool has_i2c(const std::string& name) const;
  bool has_sdmmc(const std::string& name) const;
  bool has_serial(const std::string& name) const;
  bool has_can(const std::string& name) const;
  // Lists of what is allowed: "TIM1, TIM2, …", those with at least so many inputs.
  std::string timers() const;
  std::string timers_with_inputs(unsigned inputs) const;
  std::string timers_with_complements() const;
  std::string example_channels() const;  // in words
  std::string spis() const;
  std::string i2cs() const;
  std::string sdmmcs() const;
  std::string cans() const;
  std::string adcs() const;
  std::string serials() const;

 private:
  class Nothing;
  std::unique_ptr<Nothing> system_;
  std::unique_ptr<Chip> chip_;
};

}  // namespace omnihil::mcu
