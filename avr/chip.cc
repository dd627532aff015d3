#include "avr/chip.h"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <stdexcept>
#include <utility>

extern "C" {
#include <simavr/avr_adc.h>
#include <simavr/avr_eeprom.h>
#include <simavr/avr_extint.h>
#include <simavr/avr_ioport.h>
#include <simavr/avr_uart.h>
#include <simavr/sim_cycle_timers.h>
#include <simavr/sim_interrupts.h>
#include <simavr/sim_io.h>
}

namespace omnihil_avr {
namespace {
constexpr double kTwoPi = 6.283185307179586;
constexpr std::int64_t kNsPerSecond = 1'000'000'000;
constexpr unsigned kSupply_mV = 5000;
constexpr std::size_t kMostNotes = 32;

void no_sleep(avr_t*, avr_cycle_count_t) {}  // simavr would wait in real time
avr_cycle_count_t end_of_run(avr_t*, avr_cycle_count_t, void*) { return 0; }
}  // namespace

Chip* Chip::the_chip_ = nullptr;

Chip::Chip(const std::string& name, std::uint32_t hz) {
  the_chip_ = this;
  avr_global_logger_set(log);
  avr_ = avr_make_mcu_by_name(name.c_str());
  if (avr_ == nullptr) throw std::runtime_error("simavr has no chip " + name);
  avr_init(avr_);
  avr_->frequency = hz;
  avr_->sleep = no_sleep;
  avr_->log = LOG_WARNING;
  avr_->vcc = avr_->avcc = avr_->aref = kSupply_mV;
  avr_->codeend = avr_->flashend;
  own_reset_ = avr_->reset;
  avr_->reset = on_reset;
}

Chip::~Chip() {
  if (avr_ != nullptr) avr_terminate(avr_);
}

void Chip::load_flash(std::uint32_t address, const std::vector<std::uint8_t>& bytes) {
  const std::uint64_t end = std::uint64_t{address} + bytes.size(), flash = std::uint64_t{avr_->flashend} + 1;
  if (end > flash) {
    throw std::runtime_error("the image reaches to byte " + std::to_string(end) + " of the flash; it has " +
                             std::to_string(flash));
  }
  std::copy(bytes.begin(), bytes.end(), avr_->flash + address);
}

void Chip::load_eeprom(std::uint32_t address, const std::vector<std::uint8_t>& bytes) {
  avr_eeprom_desc_t part{};
  part.ee = const_cast<std::uint8_t*>(bytes.data());
  part.offset = static_cast<std::uint16_t>(address);
  part.size = static_cast<std::uint32_t>(bytes.size());
  if (address > 0xFFFF || avr_ioctl(avr_, AVR_IOCTL_EEPROM_SET, &part) == -2) {
    throw std::runtime_error("EEPROM: " + std::to_string(bytes.size()) + " bytes at " +
                             std::to_string(address) + " do not fit");
  }
}

PinAddress Chip::address(Pin pin) const {
  avr_ioport_state_t state{};
  if (avr_ioctl(avr_, AVR_IOCTL_IOPORT_GETSTATE(pin.port), &state) < 0 || pin.bit > 7) {
    throw std::runtime_error(std::string("the chip has no pin P") + pin.port + std::to_string(pin.bit));
  }
  // The three registers of port B are at 0x23 on every chip of the family, the other ports' beside them.
  return {static_cast<std::uint16_t>(0x20 + 3 * (pin.port - 'A')), pin.bit};
}

void Chip::watch(std::uint16_t address) {
  avr_irq_register_notify(
      avr_iomem_getirq(avr_, address, nullptr, AVR_IOMEM_IRQ_ALL),
      [](avr_irq_t*, std::uint32_t, void* chip) { static_cast<Chip*>(chip)->bridge_changed(); }, this);
}

void Chip::set_bridge(const BridgeWires& wires) {
  bridge_ = wires;
  has_bridge_ = true;
  std::set<std::uint16_t> registers{wires.tccra, wires.tccrb,     wires.ocr,
                                    wires.ocra,  wires.pwm.ddr(), wires.pwm.port()};
  if (wires.icr != 0) registers.insert(wires.icr);
  if (wires.has_direction) registers.insert({wires.direction.ddr(), wires.direction.port()});
  if (wires.has_enable) registers.insert({wires.enable.ddr(), wires.enable.port()});
  for (const std::uint16_t at : registers) watch(at);
}

void Chip::set_encoder(Pin a, Pin b, double counts_per_turn) {
  a_ = a;
  b_ = b;
  counts_per_turn_ = counts_per_turn;
}

void Chip::set_serial(char letter) {
  serial_ = letter;
  std::uint32_t flags = 0;
  avr_ioctl(avr_, AVR_IOCTL_UART_GET_FLAGS(letter), &flags);
  flags &= ~static_cast<std::uint32_t>(AVR_UART_FLAG_STDIO | AVR_UART_FLAG_POLL_SLEEP);
  avr_ioctl(avr_, AVR_IOCTL_UART_SET_FLAGS(letter), &flags);
  avr_irq_t* output = avr_io_getirq(avr_, AVR_IOCTL_UART_GETIRQ(letter), UART_IRQ_OUTPUT);
  if (output == nullptr) throw std::runtime_error(std::string("the chip has no USART") + letter);
  avr_irq_register_notify(
      output,
      [](avr_irq_t*, std::uint32_t byte, void* chip) {
        Chip& c = *static_cast<Chip*>(chip);
        c.sent_.emplace_back(c.avr_->cycle, static_cast<std::uint8_t>(byte));
      },
      this);
}

void Chip::set_control(unsigned vector, std::int64_t period_ns) {
  avr_irq_t* irq = avr_get_interrupt_irq(avr_, static_cast<std::uint8_t>(vector));
  if (irq == nullptr) throw std::runtime_error("the chip has no interrupt " + std::to_string(vector));
  control_period_ = cycle_of(period_ns);
  avr_irq_register_notify(
      irq + AVR_INT_IRQ_PENDING,
      [](avr_irq_t*, std::uint32_t on, void* chip) {
        Chip& c = *static_cast<Chip*>(chip);
        if (on != 0) c.raised_at_ = c.avr_->cycle;
      },
      this);
  avr_irq_register_notify(
      irq + AVR_INT_IRQ_RUNNING,
      [](avr_irq_t*, std::uint32_t on, void* chip) {
        if (on != 0) static_cast<Chip*>(chip)->control_entered();
      },
      this);
}

void Chip::start() {
  avr_reset(avr_);
  after_reset();
  started_ = true;
}

// ---- time

avr_cycle_count_t Chip::cycle_of(std::int64_t ns) const {
  __extension__ using Wide = __int128;
  return static_cast<avr_cycle_count_t>((Wide{ns} * avr_->frequency + kNsPerSecond - 1) / kNsPerSecond);
}

// ---- pins

void Chip::drive(Pin pin, bool level) {
  const auto at = std::find_if(driven_.begin(), driven_.end(), [pin](const auto& entry) {
    return entry.first.port == pin.port && entry.first.bit == pin.bit;
  });
  if (at == driven_.end()) {
    driven_.emplace_back(pin, level);
  } else {
    at->second = level;
  }
  // What simavr takes an input for whenever the port is written.
  avr_ioport_external_t external{};
  external.name = static_cast<unsigned long>(pin.port);
  for (const auto& [other, high] : driven_) {
    if (other.port != pin.port) continue;
    external.mask |= 1ul << other.bit;
    if (high) external.value |= 1ul << other.bit;
  }
  avr_ioctl(avr_, AVR_IOCTL_IOPORT_SET_EXTERNAL(pin.port), &external);
  avr_raise_irq(avr_io_getirq(avr_, AVR_IOCTL_IOPORT_GETIRQ(pin.port), static_cast<int>(pin.bit)), level);
  // That is not passed on where the level was the same before a reset, which clears the register.
  std::uint8_t& pins = avr_->data[address(pin).pin_register];
  pins = static_cast<std::uint8_t>((pins & ~(1u << pin.bit)) | (level ? 1u << pin.bit : 0u));
}

void Chip::analog(unsigned channel, unsigned millivolt) {
  avr_irq_t* irq = avr_io_getirq(avr_, AVR_IOCTL_ADC_GETIRQ, static_cast<int>(ADC_IRQ_ADC0 + channel));
  if (irq == nullptr) throw std::runtime_error("the chip has no ADC channel " + std::to_string(channel));
  avr_raise_irq(irq, std::min(millivolt, kSupply_mV));
}

void Chip::receive(const std::vector<std::uint8_t>& bytes) {
  avr_irq_t* input = avr_io_getirq(avr_, AVR_IOCTL_UART_GETIRQ(serial_), UART_IRQ_INPUT);
  for (const std::uint8_t byte : bytes) avr_raise_irq(input, byte);  // its FIFO keeps the line's pace
}

bool Chip::sent(std::vector<std::uint8_t>& frame) {
  // 8N1 of the slowest usual line that a robot's radio hangs on: two characters of 9600 baud are 2 ms; of a
  // faster one a pause of 0.2 ms ends the frame as surely.
  const avr_cycle_count_t gap = cycle_of(200'000);
  frame.clear();
  for (std::size_t i = 0; i < sent_.size(); ++i) {
    const avr_cycle_count_t next = i + 1 < sent_.size() ? sent_[i + 1].first : avr_->cycle;
    if (next - sent_[i].first < gap) continue;
    for (std::size_t k = 0; k <= i; ++k) frame.push_back(sent_[k].second);
    sent_.erase(sent_.begin(), sent_.begin() + static_cast<std::ptrdiff_t>(i) + 1);
    return true;
  }
  return false;
}

// ---- encoder

std::int64_t Chip::encoder_target() const {
  const double t_s =
      (static_cast<double>(avr_->cycle) / avr_->frequency) - 1e-9 * static_cast<double>(shaft_.at_ns);
  const double theta = shaft_.theta_rad + shaft_.omega_rad_s * t_s;
  return static_cast<std::int64_t>(std::floor(theta * counts_per_turn_ / kTwoPi)) + offset_;
}

// Line A leads B while the count rises: 00, 10, 11, 01.
void Chip::show_encoder() {
  const unsigned phase = static_cast<unsigned>(shown_) & 3u;
  drive(a_, phase == 1 || phase == 2);
  drive(b_, phase == 2 || phase == 3);
}

// Cycles until the count changes; 0: not within reach.
avr_cycle_count_t Chip::to_next_edge() const {
  if (encoder_target() != shown_) return cycle_of(kCatchUp_us * 1000);
  const double t_s =
      (static_cast<double>(avr_->cycle) / avr_->frequency) - 1e-9 * static_cast<double>(shaft_.at_ns);
  const double place = (shaft_.theta_rad + shaft_.omega_rad_s * t_s) * counts_per_turn_ / kTwoPi;
  const double rate = shaft_.omega_rad_s * counts_per_turn_ / kTwoPi;
  const double below = std::floor(place);
  if (rate == 0.0) return 0;
  const double way = rate > 0.0 ? below + 1.0 - place : place - below;
  const double cycles = std::ceil(way / std::abs(rate) * avr_->frequency);
  if (cycles > static_cast<double>(run_end_ - std::min(run_end_, avr_->cycle))) return 0;
  return std::max<avr_cycle_count_t>(1, static_cast<avr_cycle_count_t>(cycles));
}

// One edge: the lines move by one count toward the shaft.
avr_cycle_count_t Chip::encoder_edge() {
  const std::int64_t target = encoder_target();
  if (target != shown_) {
    shown_ += target > shown_ ? 1 : -1;
    show_encoder();
  }
  return to_next_edge();
}

void Chip::begin_shaft(const Shaft& shaft) {
  shaft_ = shaft;
  if (counts_per_turn_ == 0.0) return;
  const std::int64_t off = encoder_target() - shown_;
  if (off > kJump || off < -kJump) offset_ -= off;
  const auto edge = [](avr_t*, avr_cycle_count_t when, void* chip) -> avr_cycle_count_t {
    const avr_cycle_count_t next = static_cast<Chip*>(chip)->encoder_edge();
    return next == 0 ? 0 : when + next;
  };
  avr_cycle_timer_cancel(avr_, edge, this);
  if (const avr_cycle_count_t next = to_next_edge(); next > 0)
    avr_cycle_timer_register(avr_, next, edge, this);
}

// ---- bridge

void Chip::pass(avr_cycle_count_t at) {
  at = std::clamp(at, since_, run_end_);
  const auto held = static_cast<double>(at - since_);
  since_ = at;
  if (!held_.driven) return;
  driven_cycles_ += held;
  duty_cycles_ += held * held_.duty_ratio;
}

void Chip::bridge_changed() {
  if (!has_bridge_) return;
  pass(avr_->cycle);
  held_ = bridge_state(bridge_, avr_->data);
}

// ---- control periods

void Chip::control_entered() {
  if (entered_ && raised_at_ > entered_for_) {
    const avr_cycle_count_t periods = (raised_at_ - entered_for_ + control_period_ / 2) / control_period_;
    if (periods > 1) missed_ += periods - 1;
  }
  entered_ = true;
  entered_for_ = raised_at_;
}

// With those since the interrupt came for the last time, if it has stopped to come.
std::uint64_t Chip::missed() const {
  if (!entered_) return missed_;
  const avr_cycle_count_t since = avr_->cycle - std::min(avr_->cycle, entered_for_);
  const avr_cycle_count_t periods = since / control_period_;
  return missed_ + (periods > 2 ? periods - 2 : 0);
}

// ---- running

void Chip::on_reset(avr_t* avr) {
  if (the_chip_->own_reset_ != nullptr) the_chip_->own_reset_(avr);
  the_chip_->was_reset_ = true;
}

// simavr has cleared registers and dropped all timers of its own and ours.
void Chip::after_reset() {
  was_reset_ = false;
  // Else a line that is low before the firmware has said what to make of it raises its interrupt for ever.
  for (std::uint8_t n = 0; n < EXTINT_COUNT; ++n) avr_extint_set_strict_lvl_trig(avr_, n, 0);
  const auto inputs = driven_;
  for (const auto& [pin, level] : inputs) drive(pin, level);
  if (counts_per_turn_ != 0.0) show_encoder();
  bridge_changed();
  if (!started_) return;
  char text[80];
  std::snprintf(text, sizeof text, "reset by the watchdog at %.6f s",
                static_cast<double>(avr_->cycle) / avr_->frequency);
  note(text);
  begin_shaft(shaft_);
  avr_cycle_timer_register(avr_, run_end_ - std::min(run_end_ - 1, avr_->cycle), end_of_run, nullptr);
}

void Chip::stop(const std::string& why) {
  char text[160];
  std::snprintf(text, sizeof text, "stopped at pc 0x%04x, %.6f s: %s", avr_->pc,
                static_cast<double>(avr_->cycle) / avr_->frequency, why.c_str());
  why_stopped_ = text;
  pass(avr_->cycle);
  held_ = {};
}

Outcome Chip::run(const Shaft& shaft) {
  run_end_ = cycle_of(shaft.end_ns);
  driven_cycles_ = duty_cycles_ = 0.0;
  if (why_stopped_.empty()) {
    begin_shaft(shaft);
    if (avr_->cycle < run_end_) avr_cycle_timer_register(avr_, run_end_ - avr_->cycle, end_of_run, nullptr);
  }
  return go_on();
}

Outcome Chip::go_on() {
  while (why_stopped_.empty() && avr_->cycle < run_end_) {
    if (pause_at_ == avr_->pc) {
      pause_at_.reset();
      return {.mean = {}, .missed_periods = missed(), .paused = true};
    }
    const int state = avr_run(avr_);
    if (was_reset_) after_reset();
    if (state == cpu_Done) stop("it sleeps with interrupts off");
    if (state == cpu_Crashed) stop("an address outside its memory");
  }
  pass(run_end_);
  Outcome outcome;
  outcome.missed_periods = missed();
  if (driven_cycles_ > 0.0) outcome.mean = {true, duty_cycles_ / driven_cycles_};
  return outcome;
}

// ---- notes

void Chip::note(const std::string& text) {
  if (seen_notes_.size() < kMostNotes && seen_notes_.insert(text).second) notes_.push_back(text);
}

std::vector<std::string> Chip::take_notes() { return std::exchange(notes_, {}); }

// Errors and warnings of simavr, without its colours and line ends.
void Chip::log(avr_t*, int level, const char* format, va_list arguments) {
  if (level > LOG_WARNING || the_chip_ == nullptr) return;
  char raw[256];
  std::vsnprintf(raw, sizeof raw, format, arguments);
  std::string text;
  for (const char* c = raw; *c != 0; ++c) {
    if (*c == '\033') {
      while (*c != 0 && *c != 'm') ++c;
      if (*c == 0) break;
    } else if (*c >= ' ') {
      text += *c;
    }
  }
  if (!text.empty()) the_chip_->note("simavr: " + text);
}

}  // namespace omnihil_avr
