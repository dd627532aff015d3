// Compliance of shaft, belt or gear: rotor and output are two masses with a spring between.
#include "sim/law/effect_entry.h"
#include "sim/law/two_masses.h"

namespace omnihil {
namespace {

struct ShaftCompliance {
  enum Param { kCompliance, kDamping };
  // Both masses against each other: estimate, of 20 to 200 Hz; loss a guess, a factor of 3 either way.
  static constexpr TwoMassMode kMode{.frequency_Hz = 140.0,
                                     .loss = 0.1,
                                     .compliance_rad_per_Nm = 0.2,  // with 9e-6 and 2e-5 kg m2
                                     .damping_Nm_s_per_rad = 1e-3};
  static double compliance_of(const DriveParams<double>& drive) { return kMode.compliance_of(drive); }
  static double damping_of(const DriveParams<double>& drive) { return kMode.damping_of(drive); }

  static constexpr EffectParam kParams[] = {
      {.name = "compliance_rad_per_Nm",
       .unit = "rad/(N m)",
       .typical = kMode.compliance_rad_per_Nm,
       .lower = 0,
       .upper = 2000,
       .prior_scale = 400,  // of 3 Hz: a long arm's
       .what = "twist per torque, at the output",
       .how = "hold the rotor, load the output with a known torque, read the twist; or the resonance",
       .start_for = compliance_of,
       // a ringing at one frequency is nothing like one at twice it: no line leads from one size to another;
       // 140, 313, 63, 28, 15 and 7 Hz: a gear's, a belt's, a long arm's
       .grid = {GridOf::kStart, {1.0, 0.2, 5.0, 25.0, 90.0, 400.0}}},
      {.name = "damping_Nm_s_per_rad",
       .unit = "N m s/rad",
       .role = ParamRole::kShape,
       .neutral = kNoNeutral,
       .typical = kMode.damping_Nm_s_per_rad,
       .lower = 0,
       .upper = 100,
       .what = "torque per rate of twist, at the output",
       .how = "decay of the ringing after a step",
       .start_for = damping_of,
       .trait = ParamTrait::kSmoothing,  // none: what the bearings lose is all
       .power_of_size = -0.5},           // the same loss: d = 2 zeta sqrt(J / c)
  };
  static constexpr EffectInfo kInfo{
      .id = "shaft_compliance",
      .title = "Shaft compliance",
      .equation = "tau_shaft = twist / c + d twist', twist = theta_rotor / N - theta_out",
      .source = "Meirovitch, Fundamentals of Vibrations, 2001 (two masses, one spring)",
      .cannot = "further modes, stiffness that grows with torque, hysteresis of belts",
      .place = Place::kShaft,
      .twins = {"backlash"},
      .reveals =
          "chirp or sharp steps: resonance of the speed at (1/2 pi) sqrt((1/J_out + N^2/J_rotor) / c), "
          "at the same frequency for every amplitude",
      .visible = "a compliance whose mode lies below a third of the sampling rate",
      .min_visible =
          [](const SensorSet& s) {
            // c = 1 / (J (2 pi f)^2) with f a third of the rate, J = 6.3e-6 kg m2 (both masses in parallel)
            const double omega_rad_s = 6.283185307179586 * s.rate_Hz / 3.0;
            return 1.0 / (6.3e-6 * omega_rad_s * omega_rad_s);
          },
      .claims = kOdd,
      .numerics = kStiff,
      .params = kParams,
      .plot = {.excitation = "steps", .x = "time", .y = "velocity", .from_s = 0.35, .to_s = 0.6},
  };

  template <typename T>
  static void apply(const T* p, T*, ShaftPort<T>& port) {
    // springs in a row: compliances add up
    port.compliance_rad_per_Nm += p[kCompliance];
    if (!is_exactly(p[kCompliance], 0.0)) port.damping_Nm_s_per_rad += p[kDamping];
  }
};

}  // namespace

OMNIHIL_EFFECT(shaft_compliance, ShaftCompliance)

}  // namespace omnihil
