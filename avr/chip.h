// One AVR in simavr, wired to a motor, an encoder, voltages and a serial line.
//
//   Chip chip("atmega328p", 16'000'000);
//   chip.load_flash(0, bytes);  chip.set_bridge(wires);  chip.set_encoder(a, b, 1024);  chip.start();
//   Outcome outcome = chip.run({.end_ns = 500'000, .at_ns = 0, .theta_rad = 1.0, .omega_rad_s = 90.0});
//
// Time is the chip's cycles; nothing here knows a clock. The encoder's two lines have the levels of the shaft
// at every instant (theta + omega (t - at)), edges at their cycle. They carry edges only: where the shaft's
// position jumps by more than kJump counts from one run to the next, the lines go on from where they are.
// Between jumps and that, lost counts are made good by edges kCatchUp_us apart. Cannot: noise on lines,
// brown-out detection, what simavr lacks (its list of peripherals).
#pragma once
#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "avr/bridge.h"

namespace omnihil_avr {

struct Shaft {
  std::int64_t end_ns = 0;  // of the run
  std::int64_t at_ns = 0;   // of theta_rad
  double theta_rad = 0.0, omega_rad_s = 0.0;
};

struct Outcome {
  BridgeState mean;  // duty weighted by the time it was held, changes at their instants
  std::uint64_t missed_periods = 0;
  bool paused = false;  // it is where pause_at() said, and the run is not over
};

class Chip {
 public:
  Chip(const std::string& name, std::uint32_t hz);  // throws std::runtime_error: unknown to simavr
  ~Chip();
  Chip(const Chip&) = delete;

  void load_flash(std::uint32_t address, const std::vector<std::uint8_t>& bytes);
  void load_eeprom(std::uint32_t address, const std::vector<std::uint8_t>& bytes);
  void set_bridge(const BridgeWires& wires);
  void set_encoder(Pin a, Pin b, double counts_per_turn);
  void set_serial(char letter);
  void set_control(unsigned vector, std::int64_t period_ns);
  void start();

  PinAddress address(Pin pin) const;
  void drive(Pin pin, bool level);  // an input, from outside
  void analog(unsigned channel, unsigned millivolt);
  void receive(const std::vector<std::uint8_t>& bytes);
  // Until the first instruction that would start at or after end_ns.
  Outcome run(const Shaft& shaft);
  // Once, before the instruction at this byte of the flash, the run in progress comes back paused; go_on() ends it.
  void pause_at(std::uint32_t address) { pause_at_ = address; }
  Outcome go_on();
  // Bytes of data memory as they are, without what a program's own access would do. False: they are not there.
  bool read_data(std::uint32_t address, std::span<std::uint8_t> out) const;
  // RAM alone: behind the registers.
  bool write_data(std::uint32_t address, std::span<const std::uint8_t> bytes);
  std::uint32_t data_bytes() const, ram_begin() const;
  // What has been sent, a frame (what stood without a gap of two characters) at a time; false: no more.
  bool sent(std::vector<std::uint8_t>& frame);
  std::vector<std::string> take_notes();
  const std::string& stopped() const { return why_stopped_; }  // why it runs no more; empty: it does

 private:
  static constexpr std::int64_t kJump = 8;
  static constexpr std::int64_t kCatchUp_us = 10;

  avr_cycle_count_t cycle_of(std::int64_t ns) const;
  std::int64_t encoder_target() const;
  avr_cycle_count_t to_next_edge() const;
  avr_cycle_count_t encoder_edge();
  void show_encoder();
  void begin_shaft(const Shaft& shaft);
  void bridge_changed();
  void pass(avr_cycle_count_t at);
  void control_entered();
  std::uint64_t missed() const;
  void after_reset();
  void stop(const std::string& why);
  void watch(std::uint16_t address);
  void note(const std::string& text);
  static void log(avr_t* avr, int level, const char* format, va_list arguments);
  static void on_reset(avr_t* avr);

  static Chip* the_chip_;  // simavr's log and reset carry no argument; one chip per process
  avr_t* avr_ = nullptr;
  void (*own_reset_)(avr_t*) = nullptr;
  bool started_ = false, was_reset_ = false;
  std::optional<std::uint32_t> pause_at_;
  std::string why_stopped_;
  std::vector<std::pair<Pin, bool>> driven_;

  BridgeWires bridge_;
  bool has_bridge_ = false;
  BridgeState held_;
  avr_cycle_count_t since_ = 0, run_end_ = 0;
  double driven_cycles_ = 0.0, duty_cycles_ = 0.0;

  Pin a_, b_;
  double counts_per_turn_ = 0.0;
  Shaft shaft_;
  std::int64_t shown_ = 0, offset_ = 0;

  char serial_ = 0;
  std::vector<std::pair<avr_cycle_count_t, std::uint8_t>> sent_;

  avr_cycle_count_t control_period_ = 0, raised_at_ = 0, entered_for_ = 0;
  bool entered_ = false;
  std::uint64_t missed_ = 0;

  std::set<std::string> seen_notes_;
  std::vector<std::string> notes_;
};

}  // namespace omnihil_avr
