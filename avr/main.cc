// omnihil-avr: one AVR chip behind standard input and output. The lines are described in docs/mcu-avr.md.
#include <algorithm>
#include <cstdio>
#include <functional>
#include <iostream>
#include <map>
#include <memory>

#include "avr/chip.h"
#include "avr/words.h"

namespace omnihil_avr {
namespace {

class Server {
 public:
  // False: the conversation is over.
  void line(const std::string& text) {
    Words words(text);
    const std::string verb = words.text();
    if (verb == "chip") {
      const std::string name = words.text();
      chip_ = std::make_unique<Chip>(name, static_cast<std::uint32_t>(words.integer()));
      words.end();
      return;
    }
    if (!chip_) words.fail("\"chip\" first");
    static const std::map<std::string, void (Server::*)(Words&)> kVerbs = {
        {"flash", &Server::flash},     {"eeprom", &Server::eeprom},   {"pin", &Server::pin},
        {"adc", &Server::adc},         {"pwm", &Server::pwm},         {"direction", &Server::direction},
        {"enable", &Server::enable},   {"bridge", &Server::bridge},   {"encoder", &Server::encoder},
        {"serial", &Server::serial},   {"control", &Server::control}, {"start", &Server::start},
        {"receive", &Server::receive}, {"run", &Server::run},         {"pause", &Server::pause},
        {"go_on", &Server::go_on},     {"read", &Server::read},       {"write", &Server::write},
    };
    const auto found = kVerbs.find(verb);
    if (found == kVerbs.end()) words.fail("a known verb");
    (this->*found->second)(words);
    words.end();
  }

 private:
  static Pin pin_word(Words& words) {
    const std::string word = words.text();
    if (word.size() != 3 || word[0] != 'P' || word[1] < 'A' || word[1] > 'L' || word[2] < '0' ||
        word[2] > '7') {
      words.fail("a pin such as PB1, not " + word);
    }
    return {word[1], static_cast<unsigned>(word[2] - '0')};
  }
  void flash(Words& words) {
    const auto at = static_cast<std::uint32_t>(words.integer());
    chip_->load_flash(at, words.bytes());
  }
  void eeprom(Words& words) {
    const auto at = static_cast<std::uint32_t>(words.integer());
    chip_->load_eeprom(at, words.bytes());
  }
  void pin(Words& words) {
    const Pin pin = pin_word(words);
    chip_->drive(pin, words.integer() != 0);
  }
  void adc(Words& words) {
    const auto channel = static_cast<unsigned>(words.integer());
    chip_->analog(channel, static_cast<unsigned>(words.integer()));
  }
  void pwm(Words& words) {
    wires_.pwm = chip_->address(pin_word(words));
    wires_.bits = static_cast<unsigned>(words.integer());
    for (std::uint16_t* at : {&wires_.tccra, &wires_.tccrb, &wires_.ocr, &wires_.ocra, &wires_.icr}) {
      const std::int64_t value = words.integer();
      if (value < 0 || value > 0xFF) words.fail("a data address up to 255");
      *at = static_cast<std::uint16_t>(value);
    }
    wires_.com_shift = static_cast<unsigned>(words.integer());
    wires_.inverted = words.integer() != 0;
  }
  void direction(Words& words) {
    wires_.has_direction = true;
    wires_.direction = chip_->address(pin_word(words));
    wires_.forward_is_high = words.integer() != 0;
  }
  void enable(Words& words) {
    wires_.has_enable = true;
    wires_.enable = chip_->address(pin_word(words));
  }
  void bridge(Words& words) {
    if (wires_.ocr == 0) words.fail("\"pwm\" first");
    chip_->set_bridge(wires_);
  }
  void encoder(Words& words) {
    const Pin a = pin_word(words), b = pin_word(words);
    chip_->address(a), chip_->address(b);
    chip_->set_encoder(a, b, words.real());
  }
  void serial(Words& words) { chip_->set_serial(words.text()[0]); }
  void control(Words& words) {
    const auto vector = static_cast<unsigned>(words.integer());
    chip_->set_control(vector, words.integer());
  }
  void start(Words&) {
    chip_->start();
    say("ready");
  }
  void receive(Words& words) { chip_->receive(words.bytes()); }
  void pause(Words& words) { chip_->pause_at(words.address()); }
  // All of them, or it is refused: the chip has no such bytes.
  void read(Words& words) {
    std::vector<std::uint8_t> bytes;
    std::string refused;
    do {
      const std::uint32_t at = words.address(), count = words.address();
      std::vector<std::uint8_t> part(std::min(count, chip_->data_bytes() + 1));
      if (!chip_->read_data(at, part) && refused.empty()) refused = outside(at, count, 0);
      bytes.insert(bytes.end(), part.begin(), part.end());
    } while (refused.empty() && words.more());
    while (words.more()) words.address();
    say(refused.empty() ? "memory " + hex(bytes) : refused);
  }
  void write(Words& words) {
    const std::uint32_t at = words.address();
    const std::vector<std::uint8_t> bytes = words.bytes();
    words.end();
    say(chip_->write_data(at, bytes) ? "written" : outside(at, bytes.size(), chip_->ram_begin()));
  }
  std::string outside(std::uint32_t at, std::size_t count, std::uint32_t begin) const {
    return "refused " + std::to_string(count) + " bytes at " + std::to_string(at) +
           "; allowed: " + std::to_string(begin) + " to " + std::to_string(chip_->data_bytes() - 1);
  }
  static std::string hex(const std::vector<std::uint8_t>& bytes) {
    std::string text;
    for (const std::uint8_t byte : bytes) {
      text += "0123456789abcdef"[byte >> 4];
      text += "0123456789abcdef"[byte & 15u];
    }
    return text;
  }
  static void say(const std::string& line) {
    std::printf("%s\n", line.c_str());
    std::fflush(stdout);
  }
  void run(Words& words) {
    if (paused_) words.fail("\"go_on\": the run is not over");
    Shaft shaft;
    shaft.end_ns = words.integer();
    shaft.at_ns = words.integer();
    shaft.theta_rad = words.real();
    shaft.omega_rad_s = words.real();
    tell(chip_->run(shaft));
  }
  void go_on(Words& words) {
    if (!paused_) words.fail("a run that is paused");
    tell(chip_->go_on());
  }
  void tell(const Outcome& outcome) {
    paused_ = outcome.paused;
    if (paused_) return say("paused");
    std::vector<std::uint8_t> frame;
    while (chip_->sent(frame)) std::printf("sent %s\n", hex(frame).c_str());
    for (const std::string& note : chip_->take_notes()) std::printf("note %s\n", note.c_str());
    if (!chip_->stopped().empty()) std::printf("stopped %s\n", chip_->stopped().c_str());
    std::printf("done %d %a %llu\n", outcome.mean.driven ? 1 : 0, outcome.mean.duty_ratio,
                static_cast<unsigned long long>(outcome.missed_periods));
    std::fflush(stdout);
  }

  std::unique_ptr<Chip> chip_;
  BridgeWires wires_;
  bool paused_ = false;
};

}  // namespace
}  // namespace omnihil_avr

int main() {
  std::printf("omnihil-avr 2\n");
  std::fflush(stdout);
  omnihil_avr::Server server;
  std::string line;
  try {
    while (std::getline(std::cin, line)) server.line(line);
  } catch (const std::exception& error) {
    std::printf("error %s\n", error.what());
    std::fflush(stdout);
    return 2;
  }
  return 0;
}
