// mjbots fdcanusb: a line per command, ended by LF or CR.
//
//   can send 8001 01000a bF      ->  OK            (id hexadecimal, data, flags: B/b rate switch, F/f FD)
//   rcv 100 2404000a E B F       <-  a frame of the bus (E 29-bit, B rate switch, F FD)
//
// A host may end its line with " *XX", CRC-8 (polynomial 97h, init 0) of everything before the star; answers
// then have one, too, and a wrong one is answered by "ERR checksum". Source: mjbots fdcanusb README;
// the moteus client library's fdcanusb transport (ids above 7FFh are 29-bit ones; FD unless it says f).
// "can on", "can off", "can std", "can ext" and "can status" are answered OK without effect.
#include <fmt/format.h>

#include "hil/wire/adapter_wire.h"
#include "hil/wire/stick_wire.h"
#include "hil/wire/wire_kind.h"

namespace omnihil {
namespace {

constexpr std::size_t kMaxLine = 256;
constexpr std::uint32_t kMaxStandardId = 0x7FF;

std::uint8_t crc8(std::string_view text) {
  unsigned crc = 0;
  for (const char c : text) {
    crc ^= static_cast<std::uint8_t>(c);
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 0x80U) != 0 ? (crc << 1 ^ 0x97U) & 0xFFU : crc << 1;
  }
  return static_cast<std::uint8_t>(crc);
}

std::string_view take_word(std::string_view& text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  const std::string_view word = text.substr(0, text.find(' '));
  text.remove_prefix(word.size());
  return word;
}

// "8001 01000a bF": identifier, data and flags, the same in both directions.
bool read_frame(std::string_view text, BusFrame& f) {
  std::size_t size = 0;
  if (!read_hex_number(take_word(text), f.id) || f.id > 0x1FFF'FFFFU) return false;
  if (!read_hex(take_word(text), std::span(f.data).first(64), size)) return false;
  f.size = static_cast<std::uint8_t>(size);
  f.extended = f.id > kMaxStandardId;
  f.fd = f.bitrate_switch = true;
  for (const char flag : text) {
    if (flag == 'b' || flag == 'B') f.bitrate_switch = flag == 'B';
    if (flag == 'f' || flag == 'F') f.fd = flag == 'F';
  }
  if (!f.fd) f.bitrate_switch = false;
  return f.fd || f.size <= 8;
}

class FdcanusbStick final : public CanStick {
 public:
  std::string open() const override { return "\ncan on\n"; }
  std::string close() const override { return {}; }
  bool say(const BusFrame& f, std::string& line) const override {
    if (f.remote) return false;
    line += fmt::format("can send {:x} ", f.id);
    for (const std::uint8_t byte : f.bytes()) line += fmt::format("{:02x}", byte);
    const int padded = can_fd_length(can_fd_code(f.size));
    for (int i = f.size; f.fd && i < padded; ++i) line += fmt::format("{:02x}", f.pad);
    line += fmt::format(" {}{}\n", f.bitrate_switch ? 'B' : 'b', f.fd ? 'F' : 'f');
    return true;
  }
  bool hear(std::string_view line, BusFrame& frame) const override {
    return take_word(line) == "rcv" && read_frame(line, frame);
  }
};

class FdcanusbAdapter final : public CanAdapter {
 public:
  void receive(std::span<const std::uint8_t> bytes, std::vector<BusFrame>& frames,
               std::string& answer) override {
    for (const std::uint8_t byte : bytes) {
      if (byte != '\r' && byte != '\n') {
        if (line_.size() < kMaxLine) line_ += static_cast<char>(byte);
        continue;
      }
      if (!line_.empty()) take_line(frames, answer);
      line_.clear();
    }
  }

  bool send(const BusFrame& f, std::string& answer) override {
    std::string line = fmt::format("rcv {:x} ", f.id);
    for (const std::uint8_t byte : f.bytes()) line += fmt::format("{:02x}", byte);
    const int padded = can_fd_length(can_fd_code(f.size));
    for (int i = f.size; f.fd && i < padded; ++i) line += fmt::format("{:02x}", f.pad);
    line += fmt::format(" {} {} {}", f.extended ? 'E' : 'e', f.bitrate_switch ? 'B' : 'b', f.fd ? 'F' : 'f');
    say(line, answer);
    return true;
  }

  void host_closed() override {
    line_.clear();
    checksums_ = false;
  }

 private:
  void say(std::string line, std::string& answer) const {
    if (checksums_) line += fmt::format(" *{:02X}", crc8(line + " "));
    answer += line + "\r\n";
  }

  void take_line(std::vector<BusFrame>& frames, std::string& answer) {
    std::string_view text = line_;
    const std::size_t star = text.rfind('*');
    std::uint32_t claimed = 0;
    if (star != std::string_view::npos && star + 3 == text.size() &&
        read_hex_number(text.substr(star + 1), claimed)) {
      checksums_ = true;
      text = text.substr(0, star);
      if (crc8(text) != claimed) {
        ++bad_lines_;
        return say("ERR checksum", answer);
      }
    }
    if (take_word(text) != "can") return refuse("ERR unknown command", answer);
    const std::string_view verb = take_word(text);
    if (verb == "on" || verb == "off" || verb == "std" || verb == "ext" || verb == "status") {
      return say("OK", answer);
    }
    BusFrame f;
    if (verb != "send" || !read_frame(text, f)) return refuse("ERR malformed", answer);
    frames.push_back(f);
    say("OK", answer);
  }

  void refuse(const char* why, std::string& answer) {
    ++bad_lines_;
    say(why, answer);
  }

  std::string line_;
  bool checksums_ = false;
};

}  // namespace

std::unique_ptr<CanAdapter> make_fdcanusb_adapter() { return std::make_unique<FdcanusbAdapter>(); }

const WireKind& wire_fdcanusb() {
  static constexpr WireParameter kParameters[] = {kStickParameter};
  static constexpr WireKind kKind{
      .scheme = "fdcanusb",
      .says = "a pseudo-terminal that is an mjbots fdcanusb to whoever opens it",
      .address = "name",
      .example = "fdcanusb:./can",
      .parameters = kParameters,
      .open_frames = [](const WireUrl& url, WireProblem& problem) {
        return url.number("stick") == 1 ? open_stick_wire(url, std::make_unique<FdcanusbStick>(), problem)
                                        : open_adapter_wire(url, make_fdcanusb_adapter(), problem);
      }};
  return kKind;
}

}  // namespace omnihil
