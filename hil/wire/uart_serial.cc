#include <vector>

#include "hil/wire/burst_cutter.h"
#include "hil/wire/byte_line.h"
#include "hil/wire/uart_port.h"

namespace omnihil {
namespace {

class UartSerial final : public FramePort {
 public:
  std::string open(const std::vector<std::string>& devices, const SerialMode& mode) {
    std::string problem;
    for (const std::string& device : devices) {
      lines_.push_back({open_byte_line(device, mode, problem), {}});
      if (!problem.empty()) return problem;
    }
    return {};
  }

  bool read(BusFrame& frame) override {
    while (next_ < lines_.size()) {
      const std::size_t i = next_++;
      const auto append = [&](std::vector<std::uint8_t>& to, std::size_t limit) {
        const std::size_t before = to.size();
        to.resize(before + limit);
        to.resize(before + lines_[i].line->read(std::span(to).subspan(before)));
      };
      if (lines_[i].cutter.poll(append, static_cast<std::uint32_t>(i), frame)) return true;
    }
    next_ = 0;
    return false;
  }

  bool write(const BusFrame& frame) override { return lines_[frame.id].line->write(frame.bytes()); }

  std::string_view failure() const override {
    for (const Line& each : lines_) {
      if (!each.line->failure().empty()) return each.line->failure();
    }
    return {};
  }

 private:
  struct Line {
    std::unique_ptr<ByteLine> line;
    BurstCutter cutter;
  };
  std::vector<Line> lines_;
  std::size_t next_ = 0;
};

}  // namespace

std::unique_ptr<FramePort> open_uart_serial(const std::vector<std::string>& devices, int baud,
                                            bool even_parity, std::string& problem) {
  auto port = std::make_unique<UartSerial>();
  problem = port->open(devices, {.baud = baud, .even_parity = even_parity});
  if (!problem.empty()) return nullptr;
  return port;
}

}  // namespace omnihil
