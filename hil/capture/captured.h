// What a capture of another tool holds: pieces of bytes with times, from a CAN bus, UDP or a serial line.
//
//   Capture capture = read_capture(text, "bus.log", {});
//   for (const Captured& each : capture.pieces) …             // at_ns, way, carrier, bytes
//   for (const std::string& note : capture.notes) …            // "bus.log:7: 3 error frames: left out"
#pragma once
#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace omnihil {

enum class CaptureWay : std::uint8_t { kUnknown, kFromHost, kToHost };
enum class CaptureCarrier : std::uint8_t { kSerial, kUdp, kCan };

struct Captured {
  std::int64_t at_ns = 0;  // Unix time where the capture says so, else since its start
  CaptureWay way = CaptureWay::kUnknown;
  CaptureCarrier carrier = CaptureCarrier::kSerial;
  std::uint32_t can_id = 0;
  bool extended = false;                     // 29-bit id
  bool fd = false, bitrate_switch = false;   // CAN FD
  std::uint16_t from_port = 0, to_port = 0;  // UDP
  std::vector<std::uint8_t> bytes;
  bool operator==(const Captured&) const = default;
};

struct Capture {
  std::vector<Captured> pieces;  // in the order of their times
  bool unix_time = false;
  std::vector<std::string> notes;  // what was tolerated, with the first place of each
};

// A capture that cannot be read at all, or a piece that a format cannot hold.
class BadCapture : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Counts what was tolerated, by kind.
class CaptureNotes {
 public:
  // Places are lines, or what `place` says: "field.pcap:packet 7: error frame: left out".
  explicit CaptureNotes(std::string name, std::string place = "")
      : name_(std::move(name)), place_(std::move(place)) {}
  // `what`: "error frame: left out"; the place of its first is kept.
  void count(const std::string& what, std::size_t place);
  void say(const std::string& what);
  std::vector<std::string> list() const;

 private:
  struct Kind {
    std::string what;
    std::size_t first = 0, count = 0;
  };
  std::string name_, place_;
  std::vector<Kind> kinds_;  // in the order in which they came up
};

// Sorts pieces that are out of order, and says how many.
void sort_by_time(Capture& capture, CaptureNotes& notes);

}  // namespace omnihil
