// A board's bytes cut into CAN frames: what arrives is what was sent, and other frames on the bus do no harm.
#include "hil/wire/can_byte_wire.h"

#include <gtest/gtest.h>

#include <deque>
#include <memory>
#include <vector>

namespace omnihil {
namespace {

struct Bus {
  std::deque<BusFrame> to_bench;
  std::vector<BusFrame> from_bench;
};
class BusEnd final : public FrameWire {
 public:
  explicit BusEnd(std::shared_ptr<Bus> bus) : bus_(std::move(bus)) {}
  std::string_view name() const override { return "test"; }
  bool read(BusFrame& frame) override {
    if (bus_->to_bench.empty()) return false;
    frame = bus_->to_bench.front();
    bus_->to_bench.pop_front();
    return true;
  }
  bool write(const BusFrame& frame) override {
    bus_->from_bench.push_back(frame);
    return true;
  }

 private:
  std::shared_ptr<Bus> bus_;
};

std::vector<std::uint8_t> counting(std::size_t n) {
  std::vector<std::uint8_t> bytes(n);
  for (std::size_t i = 0; i < n; ++i) bytes[i] = static_cast<std::uint8_t>(i + 1);
  return bytes;
}

TEST(CanByteWireTest, classic_frames_carry_eight_bytes_and_the_rest) {
  auto bus = std::make_shared<Bus>();
  auto line = make_can_byte_wire(std::make_unique<BusEnd>(bus), false);
  std::error_code error;
  ASSERT_EQ(line->write(counting(44), error), 44U);
  ASSERT_EQ(bus->from_bench.size(), 6U);  // 5 * 8 + 4
  std::vector<std::uint8_t> joined;
  for (const BusFrame& f : bus->from_bench) {
    EXPECT_EQ(f.id, 0x7E0U);
    EXPECT_FALSE(f.fd || f.extended);
    joined.insert(joined.end(), f.data.begin(), f.data.begin() + f.size);
  }
  EXPECT_EQ(joined, counting(44));
}

TEST(CanByteWireTest, fd_frames_are_padded_with_zeros_to_a_length_that_exists) {
  auto bus = std::make_shared<Bus>();
  auto line = make_can_byte_wire(std::make_unique<BusEnd>(bus), true);
  std::error_code error;
  ASSERT_EQ(line->write(counting(64 + 25), error), 64U + 25U);
  ASSERT_EQ(bus->from_bench.size(), 2U);
  EXPECT_EQ(bus->from_bench[0].size, 64);
  EXPECT_EQ(bus->from_bench[1].size, 32);
  EXPECT_TRUE(bus->from_bench[1].fd && bus->from_bench[1].bitrate_switch);
  for (std::size_t i = 25; i < 32; ++i) EXPECT_EQ(bus->from_bench[1].data[i], 0);
}

TEST(CanByteWireTest, reads_the_boards_id_alone_in_any_portion) {
  auto bus = std::make_shared<Bus>();
  auto line = make_can_byte_wire(std::make_unique<BusEnd>(bus), false);
  const auto put = [&](std::uint32_t id, std::vector<std::uint8_t> bytes) {
    BusFrame f = can_frame(id, static_cast<std::uint8_t>(bytes.size()));
    std::copy(bytes.begin(), bytes.end(), f.data.begin());
    bus->to_bench.push_back(f);
  };
  put(0x7E8, {1, 2, 3, 4, 5, 6, 7, 8});
  put(0x123, {99});
  put(0x7E8, {});
  put(0x7E8, {9, 10, 11});
  std::vector<std::uint8_t> all;
  for (std::size_t before = 1; before != all.size();) {
    before = all.size();
    ASSERT_FALSE(line->read(all, 3));
  }
  EXPECT_EQ(all, counting(11));
}

}  // namespace
}  // namespace omnihil
