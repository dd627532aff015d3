// A machine with one of the test images in it, and a peripheral through which image and test talk.
#pragma once
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "firmware_iface/mcu/machine/machine.h"

namespace omnihil::mcu {

// Registers: 0 which scenario, 4 log, 8 raise line 0 after so many cycles, 12 line 0, 16 raise line 1 after.
class Probe final : public Peripheral {
 public:
  explicit Probe(System& system) : Peripheral("probe"), system_(system) {}
  void reset() override {
    due_[0] = due_[1] = kNever;
    line_ = false;
  }
  std::uint32_t read(std::uint32_t offset, unsigned) override {
    return offset == 0 ? scenario : offset == 12 ? line_ : 0;
  }
  void write(std::uint32_t offset, unsigned, std::uint32_t value) override {
    if (offset == 4) log.push_back(value), times.push_back(system_.now());
    if (offset == 8) due_[0] = system_.now() + value, system_.reschedule();
    if (offset == 12) set_line(value & 1);
    if (offset == 16) due_[1] = system_.now() + value, system_.reschedule();
  }
  Cycles next_event() const override { return std::min(due_[0], due_[1]); }
  void run_events() override {
    for (int i = 0; i < 2; ++i) {
      if (due_[i] > system_.now()) continue;
      due_[i] = kNever;
      raised_at = system_.now();
      if (i == 0) set_line(true);
      if (i == 1) system_.set_irq(1, true), system_.set_irq(1, false);
    }
  }

  std::uint32_t scenario = 0;
  std::vector<std::uint32_t> log;
  std::vector<Cycles> times;
  Cycles raised_at = 0;

 private:
  void set_line(bool high) {
    line_ = high;
    system_.set_irq(0, high);
  }
  System& system_;
  Cycles due_[2] = {kNever, kNever};
  bool line_ = false;
};

inline std::vector<std::uint8_t> file_bytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}
inline std::vector<std::uint8_t> image_bytes(const std::string& name) {
  return file_bytes(OMNIHIL_BUILD_DIR "/images/" + name + ".elf");
}

class ImageBench {
 public:
  explicit ImageBench(const std::string& name, MachineConfig config = {}) : machine(config), probe(machine) {
    std::vector<std::string> problems;
    machine.attach(0x40000000, 0x400, probe);
    if (!read_elf(image_bytes(name), image, problems) || !machine.load(image, problems)) {
      ADD_FAILURE() << name << ": " << problems[0];
      return;
    }
    machine.power_on();
  }
  std::uint32_t word(std::string_view symbol) {
    std::uint8_t raw[4] = {};
    machine.memory().read(*image.address_of(symbol), raw);
    return raw[0] | raw[1] << 8 | raw[2] << 16 | static_cast<std::uint32_t>(raw[3]) << 24;
  }
  bool done() { return word("done") == 1; }
  // To the end of main(), or `most` cycles.
  bool run(Cycles most = 20'000'000, Cycles quantum = 1'000'000) {
    for (Cycles at = quantum; at <= most && !done() && !machine.stopped(); at += quantum)
      machine.run_until(at);
    return done();
  }

  Machine machine;
  Probe probe;
  ElfImage image;
};

#define OMNIHIL_NEED_IMAGES() \
  if (image_bytes("exceptions").empty()) GTEST_SKIP() << "no images: arm-none-eabi-gcc is not installed"

}  // namespace omnihil::mcu
