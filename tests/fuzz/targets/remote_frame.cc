// The line to a board on the desk: frames of the shim, and what the bench's end does with them.
#include "firmware_iface/remote_shim/remote_frame.h"

#include <memory>
#include <vector>

#include "hil/firmware/remote_link.h"
#include "tests/fuzz/fuzz_target.h"

namespace omnihil {
namespace {

struct FromBoard final : ByteWire {
  explicit FromBoard(std::span<const std::uint8_t> sent) : bytes(sent) {}
  std::string_view name() const override { return "fuzz"; }
  std::error_code read(std::vector<std::uint8_t>& out, std::size_t limit) override {
    const auto now = take_bytes(bytes, limit);
    out.insert(out.end(), now.begin(), now.end());
    return {};
  }
  std::size_t write(std::span<const std::uint8_t> taken, std::error_code&) override { return taken.size(); }
  std::span<const std::uint8_t> bytes;
};

// As a frame that the other end takes: byte 0 the type, two of sequence, the payload.
std::vector<std::uint8_t> framed(std::span<const std::uint8_t> bytes) {
  std::vector<std::uint8_t> wire(OMNIHIL_REMOTE_WIRE_MAX);
  const std::uint8_t type = take_byte(bytes);
  const std::uint8_t low = take_byte(bytes), high = take_byte(bytes);
  const auto sequence = static_cast<std::uint16_t>(low | high << 8U);
  const auto payload = take_bytes(bytes, OMNIHIL_REMOTE_PAYLOAD_MAX);
  wire.resize(omnihil_remote_encode(type, sequence, payload.data(), payload.size(), wire.data()));
  omnihil_remote_decoder decoder{};
  omnihil_remote_frame frame{};
  int whole = 0;
  for (const std::uint8_t byte : wire) whole += omnihil_remote_decode(&decoder, byte, &frame);
  demand(whole == 1 && frame.type == type && frame.sequence == sequence && frame.bytes == payload.size(),
         "a frame goes there and back");
  demand(std::equal(payload.begin(), payload.end(), frame.payload), "with its payload");
  return wire;
}

void at_bench(std::span<const std::uint8_t> wire) {
  RemoteLink link({std::make_unique<FromBoard>(wire), 4096});
  RobotSensors sensors{};
  for (int i = 0; i < 3; ++i) link.send_sensors(sensors);
  link.poll();
  const RobotDrive& drive = link.drive();
  for (const double duty : drive.duty_ratio) demand(duty >= -1.0 && duty <= 1.0, "a duty that a bridge has");
}

}  // namespace
}  // namespace omnihil

OMNIHIL_FUZZ_TARGET(bytes) {
  using namespace omnihil;
  at_bench(bytes);
  at_bench(framed(bytes));
}
