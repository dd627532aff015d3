// SHA-256 over everything a run gives out: two runs with the same hash gave the same bytes to the host at
// the same times and had the same drives, sensors, feedback and true state at every control tick.
//
//   OutputHash hash;
//   replay(recording, session, &hash);
//   hash.hex();                          // "9f86d0…", 64 digits
//
// Hashed, in the order of the run, numbers little-endian:
//   dongle bytes   '<', time_ns as int64, count as uint64, the bytes
//   control tick   's', time_ns as int64, robot id as int64, then each of sample_columns() as a double's bits
// Every tick is hashed, however few of them a recording keeps. A change of the columns changes the hash.
#pragma once
#include <memory>
#include <string>

#include "hil/recording/recording.h"

namespace omnihil {

class OutputHash : public SessionObserver {
 public:
  OutputHash();
  ~OutputHash() override;
  OutputHash(const OutputHash&) = delete;
  OutputHash& operator=(const OutputHash&) = delete;

  void dongle_bytes(std::int64_t now_ns, std::span<const std::uint8_t> bytes) override;
  void robot_tick(std::int64_t now_ns, const RobotSample& sample) override;

  std::string hex() const;  // of what came so far

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace omnihil
