#include "hil/wire/burst_wire.h"

#include <algorithm>

#include "hil/wire/buffered_wire.h"

namespace omnihil {
namespace {

constexpr std::size_t kQueue_bytes = 16'384;  // of a host that does not read

struct Line {
  BufferedWire wire;
  std::vector<std::uint8_t> burst;

  // Whether a burst has ended in this poll.
  bool poll(BusFrame& frame) {
    const std::size_t before = burst.size();
    wire.read(burst, BusFrame::kCapacity - before);
    const bool idle = burst.size() == before;
    const bool whole = !burst.empty() && (idle || burst.size() == BusFrame::kCapacity);
    if (whole) {
      frame = BusFrame{};
      frame.size = static_cast<std::uint8_t>(burst.size());
      std::copy(burst.begin(), burst.end(), frame.data.begin());
      burst.clear();
    }
    if (wire.take_peer_closed()) {
      burst.clear();
      wire.clear();
    }
    return whole;
  }
};

class BurstWire final : public FrameWire {
 public:
  explicit BurstWire(std::vector<std::unique_ptr<ByteWire>> wires) {
    for (std::unique_ptr<ByteWire>& wire : wires) lines_.push_back({{std::move(wire), kQueue_bytes}, {}});
  }

  std::string_view name() const override { return lines_[failed()].wire.name(); }
  std::error_code error() const override { return lines_[failed()].wire.error(); }

  // A poll asks every line once; then it says that nothing waits.
  bool read(BusFrame& frame) override {
    while (next_ < lines_.size()) {
      const std::size_t i = next_++;
      if (!lines_[i].poll(frame)) continue;
      frame.id = static_cast<std::uint32_t>(i);
      return true;
    }
    next_ = 0;
    return false;
  }

  bool write(const BusFrame& frame) override {
    BufferedWire& wire = lines_[frame.id].wire;
    return wire.peer_present() && wire.write(frame.bytes());
  }

 private:
  // The first line that is gone, or the first of all.
  std::size_t failed() const {
    const auto it = std::find_if(lines_.begin(), lines_.end(),
                                 [](const Line& line) { return static_cast<bool>(line.wire.error()); });
    return it == lines_.end() ? 0 : static_cast<std::size_t>(it - lines_.begin());
  }

  std::vector<Line> lines_;
  std::size_t next_ = 0;  // the line whose turn it is in this poll
};

}  // namespace

std::unique_ptr<FrameWire> make_burst_wire(std::vector<std::unique_ptr<ByteWire>> lines) {
  return std::make_unique<BurstWire>(std::move(lines));
}

}  // namespace omnihil
