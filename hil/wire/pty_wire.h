// The virtual dongle's port: a pty under a name of the user's choice. The host opens it as the serial port
// of its team's radio dongle, closes and opens it again any time; the bench's side outlives all of that.
//
//   std::string problem;
//   auto port = PtyWire::open("./dongle", problem);  // nullptr: `problem` says why
//   port->read(bytes, 4096);
//
// Comings and goings, line modes: hil/wire/pty.h. The name: hil/wire/pty_name.h.
// A host that opens again at once is reported as closed first; its bytes come with the next read.
// Bytes written to a host wait in the kernel (about 20 kB here) until it reads; write() then takes nothing.
#pragma once
#include <memory>
#include <string>
#include <utility>

#include "hil/wire/byte_wire.h"
#include "hil/wire/pty.h"
#include "hil/wire/pty_name.h"

namespace omnihil {

class PtyWire final : public ByteWire {
 public:
  static std::unique_ptr<PtyWire> open(const std::string& path, std::string& problem);

  std::string_view name() const override { return label_; }
  std::error_code read(std::vector<std::uint8_t>& out, std::size_t limit) override;
  std::size_t write(std::span<const std::uint8_t> bytes, std::error_code& error) override;
  int handle() const override { return present_ ? pty_->master() : -1; }  // without a peer it is always ready
  bool peer_present() const override { return present_; }
  bool take_peer_closed() override { return std::exchange(closed_, false); }
  const std::string& slave_path() const { return pty_->slave_path(); }

 private:
  PtyWire() = default;
  std::error_code host_left();

  std::unique_ptr<Pty> pty_;
  PtyName name_;
  std::string label_;  // "pty:./dongle"
  bool present_ = false;
  bool visited_ = false;  // somebody has opened it since the line was made fresh
  bool closed_ = false;
};

}  // namespace omnihil
