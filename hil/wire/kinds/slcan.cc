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
#include "hil/wire/wire_kind.h"

namespace omnihil {
namespace {

constexpr std::size_t kMaxLine = 160;  // B + 8 + 1 + 128 and some
constexpr char kYes = '\r', kNo = '\a';

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
    if (!open_) return false;
    char letter = f.extended ? 'T' : 't';
    if (f.remote) letter = f.extended ? 'R' : 'r';
    if (f.fd) letter = f.bitrate_switch ? (f.extended ? 'B' : 'b') : (f.extended ? 'D' : 'd');
    answer += f.extended ? fmt::format("{}{:08X}", letter, f.id) : fmt::format("{}{:03X}", letter, f.id);
    const int code = can_fd_code(f.size);
    answer += fmt::format("{:X}", code);
    if (!f.remote) {
      for (const std::uint8_t byte : f.bytes()) answer += fmt::format("{:02X}", byte);
      for (int i = f.size; i < can_fd_length(code); ++i) answer += fmt::format("{:02X}", f.pad);
    }
    answer += '\r';
    return true;
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
    const bool good = open_ && read_frame(f);
    if (good) {
      frames.push_back(f);
      answer += f.extended ? 'Z' : 'z';
    } else {
      ++bad_lines_;
    }
    answer += good ? kYes : kNo;
  }

  bool read_frame(BusFrame& f) const {
    const char letter = line_[0];
    if (std::string_view("tTrRdDbB").find(letter) == std::string_view::npos) return false;
    f.extended = letter >= 'A' && letter <= 'Z';
    f.remote = letter == 'r' || letter == 'R';
    f.bitrate_switch = letter == 'b' || letter == 'B';
    f.fd = f.bitrate_switch || letter == 'd' || letter == 'D';
    const std::size_t digits = f.extended ? 8 : 3;
    const std::string_view text = line_;
    std::uint32_t code = 0;
    if (text.size() < digits + 2 || !read_hex_number(text.substr(1, digits), f.id)) return false;
    if (f.id > (f.extended ? 0x1FFF'FFFFU : 0x7FFU)) return false;
    if (!read_hex_number(text.substr(1 + digits, 1), code) || (!f.fd && code > 8)) return false;
    const auto length = static_cast<std::size_t>(can_fd_length(static_cast<int>(code)));
    std::size_t size = 0;
    if (!read_hex(text.substr(2 + digits), f.data, size)) return false;
    if (size != (f.remote ? 0 : length)) return false;
    f.size = static_cast<std::uint8_t>(f.remote ? 0 : length);
    return true;
  }

  std::string line_;
  bool open_ = false;
};

}  // namespace

std::unique_ptr<CanAdapter> make_slcan_adapter() { return std::make_unique<SlcanAdapter>(); }

const WireKind& wire_slcan() {
  static constexpr WireKind kKind{
      .scheme = "slcan",
      .says = "a pseudo-terminal that is a USB-CAN stick (LAWICEL ASCII) to whoever opens it",
      .address = "name",
      .example = "slcan:./can",
      .open_frames = [](const WireUrl& url, WireProblem& problem) {
        return open_adapter_wire(url, make_slcan_adapter(), problem);
      }};
  return kKind;
}

}  // namespace omnihil
