// One axis of a board with the shim of remote_plant.h: a drive for each of its sensor frames, on the board's own clock.
//
//   RemoteAxis axis(BufferedWire(std::move(wire), 4096), 0);         // its motor 0
//   if (!axis.greet(problem)) …                                      // what came instead of its HELLO
//   axis.ask(0.4, now_ns);                                           // duty, from the next answer on
//
// The board says with its sensors which drive is in force, so a sample's value is what was, not what was meant. What it
// does not hear for its time-out it lets go. Bytes of both directions are the log.
#pragma once
#include <array>

#include "firmware_iface/remote_shim/remote_shim.h"
#include "hil/acquire/axis_end.h"
#include "hil/wire/buffered_wire.h"

namespace omnihil {

class RemoteAxis final : public AxisEnd {
 public:
  static constexpr int kMotors = OMNIHIL_REMOTE_WHEELS;

  RemoteAxis(BufferedWire wire, int motor);
  RemoteAxis(const RemoteAxis&) = delete;
  RemoteAxis& operator=(const RemoteAxis&) = delete;

  // Waits 3 s at most.
  bool greet(std::string& problem);
  const omnihil_remote_robot& robot() const { return shim_.robot; }
  std::uint64_t lost_frames() const { return lost_frames_; }  // sensors that did not come, or came damaged

  std::string_view name() const override { return wire_.name(); }
  int handle() const override { return wire_.handle(); }
  void ask(double value, std::int64_t now_ns) override;
  void stop(std::int64_t now_ns) override;
  void read(std::int64_t now_ns, std::vector<AxisMoment>& out) override;
  std::string lost() const override { return std::string(wire_.failure()); }
  bool device_clock() const override { return true; }
  double counts_per_turn() const override;

 private:
  static void write(void* self, const std::uint8_t* bytes, std::size_t count);
  void answer();
  AxisMoment reading(std::int64_t now_ns);
  void log(char way, std::span<const std::uint8_t> bytes);

  BufferedWire wire_;
  int motor_;
  omnihil_remote shim_{};
  std::int64_t now_ns_ = 0;
  double asked_ = AxisMoment::kNotTold;
  std::array<double, 65536> sent_;  // duty of the drive with that number; NaN: the bridge is off
  // unwrapped
  bool first_ = true;
  std::uint32_t last_us_ = 0, last_counts_ = 0;
  std::uint16_t last_number_ = 0;
  std::int64_t board_us_ = 0, counts_ = 0;
  std::uint64_t lost_frames_ = 0;
};

}  // namespace omnihil
