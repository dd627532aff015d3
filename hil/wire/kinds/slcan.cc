// LAWICEL CAN232 ASCII: a line per command, ended by CR; CR answers yes, BEL no.
//
//   S6 CR            500 kbit/s (taken, without effect here)      O CR   open      C CR   close
//   t0078080000.. CR 11-bit id 007, 8 bytes                       T 29-bit id, r and R remote requests
//   d / D            CAN FD, 11 / 29-bit id                       b / B  the same with bit rate switch
//
// Source: LAWICEL AB, CAN232 manual V3; the FD letters as CANable 2.0 and python-can (slcan, since 4.4) have
// them: the length digit is then the FD length code 0 to F. Frames before O are refused; a baud rate is of no
// meaning on a simulated bus. Time stamps (Z1) and acceptance filters (M, m) are taken without effect.
#include <fmt/format.h>

#include <algorithm>

#include "hil/wire/adapter_wire.h"
#include "hil/wire/stick_wire.h"
#include "hil/wire/wire_kind.h"

namespace omnihil {
namespace {

constexpr std::size_t kMaxLine = 160;  // B + 8 + 1 + 128 and some
constexpr char kYes = '\r', kNo = '\a';

// A frame as a line, the same in both directions.
void say_frame(const BusFrame& f, std::string& line) {
  char letter = f.extended ? 'T' : 't';
  if (f.remote) letter = f.extended ? 'R' : 'r';
  if (f.fd) letter = f.bitrate_switch ? (f.extended ? 'B' : 'b') : (f.extended ? 'D' : 'd');
  line += f.extended ? fmt::format("{}{:08X}", letter, f.id) : fmt::format("{}{:03X}", letter, f.id);
  const int code = can_fd_code(f.size);
  line += fmt::format("{:X}", code);
  if (!f.remote) {
    for (const std::uint8_t byte : f.bytes()) line += fmt::format("{:02X}", byte);
    for (int i = f.size; i < can_fd_length(code); ++i) line += fmt::format("{:02X}", f.pad);
  }
  line += '\r';
}

bool read_frame(std::string_view line, BusFrame& f) {
  if (line.empty()) return false;
  const char letter = line[0];
  if (std::string_view("tTrRdDbB").find(letter) == std::string_view::npos) return false;
  f.extended = letter >= 'A' && letter <= 'Z';
  f.remote = letter == 'r' || letter == 'R';
  f.bitrate_switch = letter == 'b' || letter == 'B';
  f.fd = f.bitrate_switch || letter == 'd' || letter == 'D';
  const std::size_t digits = f.extended ? 8 : 3;
  std::uint32_t code = 0;
  if (line.size() < digits + 2 || !read_hex_number(line.substr(1, digits), f.id)) return false;
  if (f.id > (f.extended ? 0x1FFF'FFFFU : 0x7FFU)) return false;
  if (!read_hex_number(line.substr(1 + digits, 1), code) || (!f.fd && code > 8)) return false;
  const auto length = static_cast<std::size_t>(can_fd_length(static_cast<int>(code)));
  std::size_t size = 0;
  if (!read_hex(line.substr(2 + digits), f.data, size)) return false;
  if (size != (f.remote ? 0 : length)) return false;
  f.size = static_cast<std::uint8_t>(f.remote ? 0 : length);
  return true;
}

// Bit rates of S0 to S8, and of Y in Mbit/s as CANable 2.0 has it.
constexpr int kBitRates[] = {10'000, 20'000, 50'000, 100'000, 125'000, 250'000, 500'000, 800'000, 1'000'000};

class SlcanStick final : public CanStick {
 public:
  SlcanStick(int code, int data_Mbit_s) : code_(code), data_Mbit_s_(data_Mbit_s) {}
  // Empty lines and C first: whatever the stick was left in.
  std::string open() const override {
    std::string text = fmt::format("\r\rC\rS{}\r", code_);
    if (data_Mbit_s_ > 0) text += fmt::format("Y{}\r", data_Mbit_s_);
    return text + "O\r";
  }
  std::string close() const override { return "C\r"; }
  bool say(const BusFrame& frame, std::string& line) const override {
    say_frame(frame, line);
    return true;
  }
  bool hear(std::string_view line, BusFrame& frame) const override {
    // An answer to a frame of ours ("z") may stand before one of the bus without an end between.
    while (!line.empty() && (line.front() == 'z' || line.front() == 'Z')) line.remove_prefix(1);
    return read_frame(line, frame);
  }

 private:
  int code_, data_Mbit_s_;
};

class SlcanAdapter final : public CanAdapter {
 public:
  void receive(std::span<const std::uint8_t> bytes, std::vector<BusFrame>& frames,
               std::string& answer) override {
    for (const std::uint8_t byte : bytes) {
      if (byte == '\n') continue;
      if (byte != '\r') {
        if (line_.size() < kMaxLine) line_ += static_cast<char>(byte);
        continue;
      }
      take_line(frames, answer);
      line_.clear();
    }
  }

  bool send(const BusFrame& f, std::string& answer) override {
    if (open_) say_frame(f, answer);
    return open_;
  }

  void host_closed() override {
    open_ = false;
    line_.clear();
  }

 private:
  void take_line(std::vector<BusFrame>& frames, std::string& answer) {
    if (line_.empty()) return;  // hosts send CRs to clear the line
    switch (line_[0]) {
      case 'O':
      case 'L':
        open_ = true;
        break;
      case 'C':
        open_ = false;
        break;
      case 'S':
      case 's':
      case 'Y':  // data bit rate of CAN FD
      case 'Z':
      case 'M':
      case 'm':
        break;
      case 'V':
        answer += "V1013";
        break;
      case 'N':
        answer += "NHIL1";
        break;
      case 'F':
        answer += "F00";
        break;
      default:
        take_frame(frames, answer);
        return;
    }
    answer += kYes;
  }

  void take_frame(std::vector<BusFrame>& frames, std::string& answer) {
    BusFrame f;
    const bool good = open_ && read_frame(line_, f);
    if (good) {
      frames.push_back(f);
      answer += f.extended ? 'Z' : 'z';
    } else {
      ++bad_lines_;
    }
    answer += good ? kYes : kNo;
  }

  std::string line_;
  bool open_ = false;
};

std::unique_ptr<FrameWire> open(const WireUrl& url, WireProblem& problem) {
  if (url.number("stick") == 0) return open_adapter_wire(url, make_slcan_adapter(), problem);
  const auto* rate = std::find(std::begin(kBitRates), std::end(kBitRates), url.number("bitrate"));
  if (rate == std::end(kBitRates)) {
    problem.what = fmt::format("{}: bit rate {}; allowed: {}", url.text(), url.number("bitrate"),
                               fmt::join(kBitRates, ", "));
    return nullptr;
  }
  const auto code = static_cast<int>(rate - std::begin(kBitRates));
  return open_stick_wire(url, std::make_unique<SlcanStick>(code, url.number("data") / 1'000'000), problem);
}

}  // namespace

std::unique_ptr<CanAdapter> make_slcan_adapter() { return std::make_unique<SlcanAdapter>(); }

const WireKind& wire_slcan() {
  static constexpr WireParameter kParameters[] = {
      kStickParameter,
      {.name = "bitrate", .says = "bit rate of a stick", .usual = "500000", .low = 10'000, .high = 1'000'000},
      {.name = "data",
       .says = "data bit rate of a stick, CAN FD; 0: none",
       .usual = "0",
       .low = 0,
       .high = 8'000'000},
  };
  static constexpr WireKind kKind{
      .scheme = "slcan",
      .says = "a pseudo-terminal that is a USB-CAN stick (LAWICEL ASCII) to whoever opens it",
      .address = "name",
      .example = "slcan:./can",
      .parameters = kParameters,
      .open_frames = open};
  return kKind;
}

}  // namespace omnihil
