// What the legs of a three-phase bridge were on the mean of an interval.
//
//   LegMeans means;
//   means.begin(wire_legs, t0_ns);
//   means.hold(changed_legs, t_ns);              // from then on
//   BridgeLegs mean = means.end(t1_ns);          // held(): those of t1_ns
//
// Law: shares of the time for which the upper and the lower switch are on. A leg that is always at one of them is PWM of the
// upper one's share; one that has had only one of them has that one's share. A leg that was both switched and open is what it
// was longer, with the share that it had meanwhile (a commutation within the interval: half of it late at most). A leg that has
// not changed is what it was, to the last bit.
#pragma once
#include <array>
#include <cstdint>

#include "firmware_iface/robot_io.h"

namespace omnihil::mcu {

// As omnihil_motor_drive has them.
struct BridgeLegs {
  std::uint32_t leg[kLegs]{};
  double duty_ratio[kLegs]{};
};

class LegMeans {
 public:
  void begin(const BridgeLegs& legs, std::int64_t at_ns);
  void hold(const BridgeLegs& legs, std::int64_t at_ns);
  BridgeLegs end(std::int64_t at_ns);
  const BridgeLegs& held() const { return held_; }

 private:
  void pass(std::int64_t at_ns);

  // Nanoseconds of a leg.
  struct Times {
    double always_on = 0.0, other = 0.0;          // at one switch or the other all the time; partly open
    double upper_always = 0.0;                    // of always_on, at the upper switch
    double upper_other = 0.0, lower_other = 0.0;  // of the other, at each
  };
  BridgeLegs first_, held_;
  std::array<Times, kLegs> times_{};
  std::int64_t since_ns_ = 0;
  std::array<bool, kLegs> changed_{};
};

}  // namespace omnihil::mcu
