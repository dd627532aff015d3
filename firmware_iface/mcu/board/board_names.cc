#include "firmware_iface/mcu/board/board_names.h"

#include <charconv>

#include "firmware_iface/mcu/stm32/adc/adc.h"
#include "firmware_iface/mcu/stm32/can.h"
#include "firmware_iface/mcu/stm32/i2c.h"
#include "firmware_iface/mcu/stm32/sdmmc.h"
#include "firmware_iface/mcu/stm32/serial_port.h"
#include "firmware_iface/mcu/stm32/spi.h"
#include "firmware_iface/mcu/stm32/timer/timer.h"

namespace omnihil::mcu {
namespace {
std::optional<unsigned> parse_number(std::string_view text) {
  unsigned value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::string join(const std::vector<std::string>& names) {
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : ", ") + name;
  return all;
}
}  // namespace

std::optional<PinName> parse_pin(std::string_view text) {
  if (text.starts_with("GP")) {
    const auto pin = parse_number(text.substr(2));
    if (!pin || *pin > 29) return std::nullopt;
    return PinName{PinBank::kGp, *pin};
  }
  if (text.size() < 3 || text[0] != 'P' || text[1] < 'A' || text[1] > 'K') return std::nullopt;
  const auto pin = parse_number(text.substr(2));
  if (!pin || *pin > 15) return std::nullopt;
  return PinName{text[1], *pin};
}

std::optional<ChannelName> parse_channel(std::string_view text) {
  const std::size_t dot = text.find('.');
  if (dot == std::string_view::npos) return std::nullopt;
  ChannelName channel{std::string(text.substr(0, dot)), 0, text.ends_with('N')};
  std::string_view number = text.substr(dot + 1);
  if (channel.complement) number.remove_suffix(1);
  if (number == "A" || number == "B") {
    channel.channel = number == "B" ? 1 : 0;
    channel.by_letter = true;
    return channel;
  }
  const auto n = parse_number(number);
  if (!n || *n < 1 || *n > 4) return std::nullopt;
  channel.channel = *n - 1;
  return channel;
}

// A system in which nothing happens: the chip is only asked what it has.
class BoardNames::Nothing final : public System {
 public:
  Cycles now() const override { return 0; }
  std::int64_t to_ns(Cycles) const override { return 0; }
  Cycles from_ns(std::int64_t) const override { return 0; }
  double core_hz() const override { return 1e6; }
  void set_core_hz(double) override {}
  void set_irq(int, bool) override {}
  void reschedule() override {}
  void request_reset(std::string_view) override {}
  std::string_view reset_cause() const override { return "power-on"; }
  std::uint32_t bus_read(std::uint32_t, unsigned) override { return 0; }
  void bus_write(std::uint32_t, unsigned, std::uint32_t) override {}
  void map_at_zero(std::uint32_t) override {}
  void program_flash(std::uint32_t, std::span<const std::uint8_t>) override {}
  void report_unmodelled(std::string_view, std::string_view) override {}
};

BoardNames::BoardNames(const ChipSpec& spec)
    : system_(std::make_unique<Nothing>()), chip_(std::make_unique<Chip>(spec, *system_)) {}
BoardNames::~BoardNames() = default;

bool BoardNames::has_pin(const PinName& pin) const {
  const PinBank* bank = chip_->port(pin.port);
  return bank != nullptr && bank->has(pin.pin);
}
bool BoardNames::has_timer(const std::string& name) const { return chip_->find<PwmOutputs>(name) != nullptr; }
bool BoardNames::has_inputs(const std::string& name, unsigned inputs) const {
  const Timer* timer = chip_->find<Timer>(name);
  return timer != nullptr && timer->spec().channels >= inputs;
}
bool BoardNames::has_channel(const ChannelName& c) const {
  const auto* timer = chip_->find<PwmOutputs>(c.timer);
  return timer != nullptr && c.by_letter == !timer->channel_letters().empty() &&
         c.channel < (c.complement ? timer->complements() : timer->channels());
}
bool BoardNames::has_adc(const std::string& name) const { return chip_->find<Adc>(name) != nullptr; }
bool BoardNames::has_spi(const std::string& name) const { return chip_->find<Spi>(name) != nullptr; }
bool BoardNames::has_i2c(const std::string& name) const { return chip_->find<I2c>(name) != nullptr; }
bool BoardNames::has_sdmmc(const std::string& name) const { return chip_->find<Sdmmc>(name) != nullptr; }
bool BoardNames::has_serial(const std::string& name) const {
  return chip_->find<SerialPort>(name) != nullptr;
}
bool BoardNames::has_can(const std::string& name) const { return chip_->find<CanPort>(name) != nullptr; }
std::string BoardNames::timers() const { return join(chip_->names<PwmOutputs>()); }
std::string BoardNames::timers_with_inputs(unsigned inputs) const {
  std::vector<std::string> names = chip_->names<Timer>();
  std::erase_if(names, [&](const std::string& name) { return !has_inputs(name, inputs); });
  return join(names);
}
std::string BoardNames::timers_with_complements() const {
  std::vector<std::string> names = chip_->names<PwmOutputs>();
  std::erase_if(names,
                [&](const std::string& name) { return chip_->find<PwmOutputs>(name)->complements() == 0; });
  return join(names);
}
std::string BoardNames::example_channels() const {
  std::vector<std::string> names = chip_->names<PwmOutputs>();
  std::erase_if(names,
                [&](const std::string& name) { return chip_->find<PwmOutputs>(name)->channels() == 0; });
  if (names.empty()) return "none";
  const std::string_view letters = chip_->find<PwmOutputs>(names.front())->channel_letters();
  return "channels such as " + names.front() + "." +
         (letters.empty() ? "1" : std::string(letters.substr(0, 1))) + " of " + join(names);
}
std::string BoardNames::adcs() const { return join(chip_->names<Adc>()); }
std::string BoardNames::serials() const { return join(chip_->names<SerialPort>()); }
std::string BoardNames::spis() const { return join(chip_->names<Spi>()); }
std::string BoardNames::i2cs() const { return join(chip_->names<I2c>()); }
std::string BoardNames::sdmmcs() const { return join(chip_->names<Sdmmc>()); }
std::string BoardNames::cans() const {
  std::vector<std::string> names;
  for (const Chip::Mapped& block : chip_->blocks()) {
    if (dynamic_cast<CanPort*>(block.peripheral) != nullptr) names.push_back(block.peripheral->name());
  }
  return join(names);
}

}  // namespace omnihil::mcu
