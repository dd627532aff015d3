// What dongles have in common, whatever their air: counts by cause, bytes that wait for a host which reads
// late, which way a packet may go, whom it is for, and its hand-over to a robot's firmware.
//
//   struct MyDongle : Dongle {
//     MyDongle(const RadioFormat& f, const RadioLinkConfig& c) : Dongle(f, c, 16384) {}
//     PacketError keep_for(int id, const Values& values);
//     void packet(const Values& values) {
//       from_host_.count(for_addressed(address_of(values), [&](int id) { return keep_for(id, values); }));
//     }
//   };
//
// Around it: ring.h (bounded queue), air_queue.h (what arrives when), outbox.h (latest command and queue of a robot), robot_table.h,
// kept_packet.h, heartbeat.h, delimited_stream.h and sized_stream.h (bytes into frames). plain_dongle.h is
// the whole of a dongle that does no more than pass frames on. All of it is a pure function of bytes and
// times; after start nothing is allocated.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "protocols/radio_format.h"
#include "protocols/radio_link.h"

namespace omnihil {

// Whom a packet is for, by the roles of its fields.
struct Address {
  int robot = -1;  // -1: its table names none; it is for the one robot behind the wire
  std::optional<Team> team;
  bool all_robots = false;
  bool dongle = false;
  bool host = false;
};
Address address_of(const Values& values);

// Packets of this kind come from robots or dongles alone.
bool never_from_host(const Message& message);

class Dongle : public RadioLink {
 public:
  // `host_buffer_bytes` wait for a host that does not read; more are dropped as overrun.
  Dongle(const RadioFormat& format, const RadioLinkConfig& config, std::size_t host_buffer_bytes);

  void take_host_bytes(std::int64_t now_ns, std::vector<std::uint8_t>& out) override;
  void host_closed(std::int64_t now_ns) override;
  const PacketCounts& from_host() const final { return from_host_; }
  const PacketCounts& from_robots() const final { return from_robots_; }

 protected:
  // kNone, or the worst that `keep(id)` said of the robots the packet is for.
  template <class Keep>
  PacketError for_addressed(const Address& address, Keep&& keep) const {
    if (address.robot < 0 && config_.robot_ids.size() == 1) return keep(config_.robot_ids.front());
    if (!address.all_robots) return keep(address.robot);
    PacketError error = config_.robot_ids.empty() ? PacketError::kAddress : PacketError::kNone;
    for (const int id : config_.robot_ids) {
      const PacketError one = keep(id);
      if (one != PacketError::kNone) error = one;
    }
    return error;
  }

  // Asks the air once for a packet that would arrive at `at_ns`: arrive(late_ns) for each copy that does.
  template <class Arrive>
  void through_air(int robot, AirWay way, std::int64_t at_ns, Arrive&& arrive) const {
    if (config_.air == nullptr) return arrive(std::int64_t{0});
    const AirFate fate = config_.air->fate(robot, way, at_ns);
    for (int i = 0; i < fate.copies; ++i) arrive(fate.late_ns[static_cast<std::size_t>(i)]);
  }
  // How many can be under way at once in an AirQueue that only the air fills.
  std::size_t air_room() const { return config_.air == nullptr ? 0 : kAirRoom; }
  // A copy that arrives, with what the air flipped in it. False: its own checks refuse it, and nobody acts on it. A
  // firmware that decodes gets every one and refuses by itself.
  bool survives(int robot, AirWay way, std::span<std::uint8_t> packet);
  void crowded_out(AirWay way) const { config_.air->judged(way, AirVerdict::kCrowded); }
  // Why a robot would not act on a packet that came over the air.
  virtual PacketError fault_to_robot(int robot, std::span<const std::uint8_t> packet) const;
  // A frame that a robot's firmware sent: what is wrong with it by itself.
  PacketError fault_from_robot(std::span<const std::uint8_t> frame) const;
  // Frame as it is, for a firmware that decodes by itself.
  static void deliver_frame(RadioSink& sink, int robot, const Message& message,
                            std::span<const std::uint8_t> frame, std::int64_t at_ns);

  PacketError to_host(std::span<const std::uint8_t> bytes);  // kOverrun: no room
  PacketError to_host(const Values& values);                 // encoded; a table's own values never fail
  void encode(const Values& values, std::vector<std::uint8_t>& out) const;

  const RadioFormat& format_;
  const RadioLinkConfig config_;
  PacketCounts from_host_;
  PacketCounts from_robots_;

 private:
  static constexpr std::size_t kAirRoom = 1024;  // choice: 16 robots at 100 Hz, 0.6 s late

  std::size_t host_buffer_bytes_;
  std::vector<std::uint8_t> host_out_;
  std::vector<std::uint8_t> encoded_;
};

}  // namespace omnihil
