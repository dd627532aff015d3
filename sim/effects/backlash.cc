// Backlash: play between rotor and output, in which no torque passes; beyond it flanks that give a little.
#include <cmath>

#include "sim/law/effect_entry.h"
#include "sim/law/two_masses.h"

namespace omnihil {
namespace {

struct Backlash {
  enum Param { kGap, kCompliance, kDamping };
  // Both masses against each other: estimate, of shafts 20 to 200 Hz; loss a guess, a factor of 3 either way.
  static constexpr TwoMassMode kContact{.frequency_Hz = 150.0,
                                        .loss = 0.5,
                                        .compliance_rad_per_Nm = 0.03,  // with 1.2e-4 and 4.6e-5 kg m2
                                        .damping_Nm_s_per_rad = 0.03};
  static double compliance_of(const DriveParams<double>& drive) { return kContact.compliance_of(drive); }
  static double damping_of(const DriveParams<double>& drive) { return kContact.damping_of(drive); }

  static constexpr EffectParam kParams[] = {
      {.name = "gap_rad",
       .unit = "rad",
       .typical = 0.005,  // spur gear 3:1 0.1 to 0.3 deg (estimate); small servo 1 deg (measured)
       .lower = 0,
       .upper = 0.5,
       .prior_scale = 0.01,
       .what = "whole play at the output, from contact to contact",
       .how = "hold the rotor, move the output by hand against a dial; or two encoders at small reversals",
       .grid = {GridOf::kStart, {1.0, 5.0}}},
      {.name = "contact_compliance_rad_per_Nm",
       .unit = "rad/(N m)",
       .role = ParamRole::kShape,
       .neutral = kNoNeutral,
       .typical = kContact.compliance_rad_per_Nm,
       .lower = 0,
       .upper = 100,
       .what = "twist of flanks and shaft per torque, in contact, at the output",
       .how = "hold the rotor, load the output with a known torque beyond the play, read the twist",
       .start_for = compliance_of,
       .grid = {GridOf::kStart, {1.0, 0.15}}},
      {.name = "contact_damping_Nm_s_per_rad",
       .unit = "N m s/rad",
       .role = ParamRole::kShape,
       .neutral = kNoNeutral,
       .typical = kContact.damping_Nm_s_per_rad,
       .lower = 0,
       .upper = 100,
       .what = "torque per rate of twist, in contact, at the output: how little it bounces",
       .how = "decay of the bounces after a reversal",
       .start_for = damping_of},
  };
  static constexpr EffectInfo kInfo{
      .id = "backlash",
      .title = "Backlash",
      .equation =
          "tau_shaft = 0 while |x| <= gap / 2, x = theta_rotor / N - theta_out; beyond, in contact, "
          "(|x| - gap / 2) sgn(x) / c + d x', never pulling",
      .source = "Nordin, Gutman, Automatica 38(10), 2002 (dead zone model)",
      .cannot =
          "friction of the flanks within the play, oil film, a gap that differs around the turn, flanks that "
          "stiffen with force",
      .place = Place::kShaft,
      .twins = {"shaft_compliance", "actuator_delay"},
      .reveals =
          "small slow reversals with encoders on rotor and output: hysteresis of width gap; with one "
          "encoder a pause of the output after each reversal, the longer the slower; on a robot the encoders "
          "against the camera, turning to and fro",
      .visible = "two counts of an encoder on the output",
      .min_visible = [](const SensorSet& s) { return 2.0 * 6.283185307179586 / s.counts_per_turn; },
      .claims = kOdd,
      .numerics = kStiff | kImpacts,
      .params = kParams,
      .plot = {.excitation = "creep", .x = "time", .y = "velocity", .from_s = 0.0, .to_s = 16.0},
  };

  template <typename T>
  static void apply(const T* p, T*, ShaftPort<T>& port) {
    // plays in a row add up, compliances too
    port.gap_rad += p[kGap];
    if (is_exactly(p[kGap], 0.0)) return;
    port.compliance_rad_per_Nm += p[kCompliance];
    port.damping_Nm_s_per_rad += p[kDamping];
  }
};

}  // namespace

OMNIHIL_EFFECT(backlash, Backlash)

}  // namespace omnihil
