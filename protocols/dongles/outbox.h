// What a dongle holds for one robot until it is this robot's turn on the air: the latest command and the
// latest kill have a slot each, everything else waits in order.
//
//   Outbox<127, 40> outbox;
//   if (!outbox.keep(message, bytes)) ++overrun;        // the queue is full; a slot never is
//   while (const auto packet = outbox.next(room)) …     // command, kill, then the queue, while they fit
#pragma once
#include <optional>
#include <utility>

#include "protocols/dongles/kept_packet.h"
#include "protocols/dongles/ring.h"
#include "protocols/field_table.h"

namespace omnihil {

template <std::size_t kBytes, std::size_t kQueue>
class Outbox {
 public:
  using Packet = KeptPacket<kBytes>;

  bool keep(const Message& message, std::span<const std::uint8_t> bytes) {
    const Packet packet = Packet::of(bytes);
    if (message.role == MessageRole::kCommand) {
      command_ = packet;
    } else if (message.role == MessageRole::kKill) {
      kill_ = packet;
    } else {
      return queue_.push(packet);
    }
    return true;
  }

  // Takes the packet whose turn it is, if it has at most `room` bytes.
  std::optional<Packet> next(std::size_t room) {
    std::optional<Packet>& slot = command_ ? command_ : kill_;
    if (slot) return slot->size <= room ? std::exchange(slot, std::nullopt) : std::nullopt;
    if (queue_.empty() || queue_.front().size > room) return std::nullopt;
    std::optional<Packet> packet = queue_.front();
    queue_.pop();
    return packet;
  }

  bool empty() const { return !command_ && !kill_ && queue_.empty(); }

 private:
  std::optional<Packet> command_;
  std::optional<Packet> kill_;
  Ring<Packet, kQueue> queue_;
};

}  // namespace omnihil
