#include "hil/wire/uart_port.h"

#include <algorithm>
#include <array>
#include <vector>

#include "hil/wire/burst_cutter.h"
#include "hil/wire/pty_transport.h"

namespace omnihil {
namespace {

struct Line {
  std::unique_ptr<PtyTransport> transport;
  BurstCutter cutter;
  std::vector<std::uint8_t> waiting;  // for the host
};
constexpr std::size_t kQueue_bytes = 16'384;  // of a host that does not read

class UartPtys final : public FramePort {
 public:
  std::string open(const std::string& path, int lines);
  bool read(BusFrame& frame) override;
  bool write(const BusFrame& frame) override;
  std::string_view failure() const override { return failure_; }

 private:
  bool take_burst(std::size_t i, BusFrame& frame);

  std::vector<Line> lines_;
  std::size_t next_ = 0;  // the line whose turn it is in this poll
  std::string failure_;
};

std::string UartPtys::open(const std::string& path, int lines) {
  std::string problem;
  for (int i = 0; i < lines && problem.empty(); ++i) {
    Line line;
    line.transport = PtyTransport::open(path + std::to_string(i), problem);
    if (line.transport) lines_.push_back(std::move(line));
  }
  return problem;
}

// A poll asks every line once; then it says that nothing waits.
bool UartPtys::read(BusFrame& frame) {
  while (next_ < lines_.size()) {
    if (take_burst(next_++, frame)) return true;
  }
  next_ = 0;
  return false;
}

bool UartPtys::take_burst(std::size_t i, BusFrame& frame) {
  Line& line = lines_[i];
  const auto append = [&](std::vector<std::uint8_t>& to, std::size_t limit) {
    const std::error_code error = line.transport->read(to, limit);
    if (error) failure_ = std::string(line.transport->url()) + ": " + error.message();
  };
  const bool whole = line.cutter.poll(append, static_cast<std::uint32_t>(i), frame);
  if (line.transport->take_host_closed()) {
    line.cutter.clear();
    line.waiting.clear();
  }
  return whole;
}

bool UartPtys::write(const BusFrame& frame) {
  Line& line = lines_[frame.id];
  if (!line.transport->host_present() || line.waiting.size() > kQueue_bytes) return false;
  line.waiting.insert(line.waiting.end(), frame.data.begin(), frame.data.begin() + frame.size);
  std::error_code error;
  const std::size_t sent = line.transport->write(line.waiting, error);
  if (error) failure_ = std::string(line.transport->url()) + ": " + error.message();
  line.waiting.erase(line.waiting.begin(), line.waiting.begin() + static_cast<std::ptrdiff_t>(sent));
  return true;
}

}  // namespace

std::unique_ptr<FramePort> open_uart_ptys(const std::string& path, int lines, std::string& problem) {
  auto port = std::make_unique<UartPtys>();
  problem = port->open(path, lines);
  if (!problem.empty()) return nullptr;
  return port;
}

}  // namespace omnihil
