// Whatever a program writes to the port that GDB is awaited at.
#include <fcntl.h>

#include <algorithm>
#include <memory>

#include "hil/debugger/gdb_server.h"
#include "hil/wire/descriptor.h"
#include "tests/fuzz/fuzz_target.h"

namespace {

using namespace omnihil;

// A client that writes these bytes, in pieces, and leaves.
class Client final : public ByteWire {
 public:
  explicit Client(std::span<const std::uint8_t> bytes)
      : rest_(bytes), always_(::open("/dev/zero", O_RDONLY)) {}
  std::string_view name() const override { return "client"; }
  int handle() const override { return always_.get(); }  // never to be waited for
  bool peer_present() const override { return !rest_.empty(); }
  bool take_peer_closed() override { return rest_.empty(); }
  std::error_code read(std::vector<std::uint8_t>& out, std::size_t) override {
    const auto part = rest_.first(std::min<std::size_t>(rest_.size(), 7));
    out.insert(out.end(), part.begin(), part.end());
    rest_ = rest_.subspan(part.size());
    return {};
  }
  std::size_t write(std::span<const std::uint8_t> bytes, std::error_code& error) override {
    error.clear();
    return bytes.size();
  }

 private:
  std::span<const std::uint8_t> rest_;
  Descriptor always_;
};

}  // namespace

OMNIHIL_FUZZ_TARGET(bytes) {
  mcu::Machine machine({.flash_bytes = 4096, .ram_bytes = 4096});
  // stack, start; adds r0, #1; str r0, [r1]; b .-4; at 0x08000100
  const std::uint8_t vectors[] = {0x00, 0x08, 0x00, 0x20, 0x01, 0x01, 0x00, 0x08};
  const std::uint8_t code[] = {0x01, 0x30, 0x08, 0x60, 0xFC, 0xE7};
  machine.memory().write(0x08000000, vectors);
  machine.memory().write(0x08000100, code);
  machine.power_on();
  machine.cpu().reg.r[1] = 0x20000100;
  GdbServer server(std::make_unique<Client>(bytes), {.wait = false});
  server.add({.robot = 0, .board = 0, .machine = &machine});
  demand(server.problem().empty(), "one board can be debugged");
  for (int run = 1; run <= 8; ++run) machine.run_until_ns(run * 10'000);
  server.end(0);
  demand(machine.to_ns(machine.now()) >= 80'000, "a client that has left holds nothing");
}
