// What waits for a wire that takes little: in order, whole, and no more than was agreed.
#include "hil/wire/buffered_wire.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace omnihil {
namespace {

using Bytes = std::vector<std::uint8_t>;

struct Far {
  Bytes got;
  std::size_t room = 0;
  std::error_code error;
};

class NarrowWire final : public ByteWire {
 public:
  explicit NarrowWire(Far& far) : far_(far) {}
  std::string_view name() const override { return "narrow"; }
  std::error_code read(Bytes&, std::size_t) override { return far_.error; }
  std::size_t write(std::span<const std::uint8_t> bytes, std::error_code& error) override {
    error = far_.error;
    const std::size_t n = std::min(bytes.size(), far_.room);
    far_.room -= n;
    far_.got.insert(far_.got.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(n));
    return n;
  }

 private:
  Far& far_;
};

TEST(BufferedWireTest, WhatDoesNotFitGoesFirstNextTime) {
  Far far{.got = {}, .room = 2, .error = {}};
  BufferedWire wire(std::make_unique<NarrowWire>(far), 10);
  EXPECT_TRUE(wire.write(Bytes{1, 2, 3}));
  EXPECT_EQ(far.got, (Bytes{1, 2}));
  far.room = 100;
  EXPECT_TRUE(wire.write(Bytes{4, 5}));
  wire.flush();
  EXPECT_EQ(far.got, (Bytes{1, 2, 3, 4, 5}));
}

TEST(BufferedWireTest, AMessageThatNoLongerFitsIsDroppedWhole) {
  Far far;
  BufferedWire wire(std::make_unique<NarrowWire>(far), 4);
  EXPECT_TRUE(wire.write(Bytes{1, 2, 3}));
  EXPECT_FALSE(wire.write(Bytes{4, 5}));
  EXPECT_TRUE(wire.write(Bytes{6}));
  far.room = 100;
  wire.flush();
  EXPECT_EQ(far.got, (Bytes{1, 2, 3, 6}));
}

TEST(BufferedWireTest, WithoutAQueueTheRestOfAMessageIsLost) {
  Far far{.got = {}, .room = 2, .error = {}};
  BufferedWire wire(std::make_unique<NarrowWire>(far), 0);
  EXPECT_FALSE(wire.write(Bytes{1, 2, 3}));
  far.room = 100;
  EXPECT_TRUE(wire.write(Bytes{4, 5}));
  EXPECT_EQ(far.got, (Bytes{1, 2, 4, 5}));
}

TEST(BufferedWireTest, TheFirstFailureIsKeptWithTheWiresName) {
  Far far;
  BufferedWire wire(std::make_unique<NarrowWire>(far), 4);
  Bytes bytes;
  wire.read(bytes, 4);
  EXPECT_EQ(wire.failure(), "");
  far.error = std::make_error_code(std::errc::io_error);
  wire.read(bytes, 4);
  far.error = std::make_error_code(std::errc::no_such_device);
  wire.read(bytes, 4);
  EXPECT_EQ(wire.error(), std::errc::io_error);
  EXPECT_EQ(wire.failure(), "narrow: " + std::make_error_code(std::errc::io_error).message());
}

}  // namespace
}  // namespace omnihil
