// Rig "axis": one drive on a bench, fed with a record of what it was asked, giving what its sensors see.
//
//   AxisInput in{.kind = CommandKind::kDuty, .time_s = t, .command = duty};
//   std::vector<AxisSample<double>> out = run_axis<double>(params, effects, in);    // one per sample of `in`
//
// Signals and their meaning are those of the measurement format (docs/effects/README.md): the command of
// sample k is held until sample k + 1; motor_current is the mean over the period that ends at its sample;
// position, velocity and load_torque belong to the output shaft. Samples need not be evenly spaced. Sensor
// effects act per sample; timing effects look back at a record of the true motion every 0.2 ms (or sub-step),
// so a measurement's age has an exact derivative. Encoder counts come unrounded (sensor_chain.h rounds them).
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "sim/drive/drive_sim.h"

namespace omnihil {

struct AxisInput {
  CommandKind kind = CommandKind::kDuty;
  std::vector<double> time_s;            // increasing
  std::vector<double> command;           // of `kind`, one per sample
  std::optional<double> command_before;  // what was asked before the first sample; none: the same as there
  std::vector<std::uint8_t> enable;      // empty: always on
  std::vector<double> bus_voltage_V;     // measured at the bridge; empty: the model's supply
  std::vector<double> imposed_velocity_rad_s;  // of the output; empty: free
  bool imposed_at_rotor = false;       // times the gear of the rotor, which a shaft parts from the output
  bool command_is_compared = false;    // inverse dynamics: torque effects see the needed motor torque instead
  std::vector<double> load_torque_Nm;  // on the output, known; empty: none
  double initial_position_rad = 0.0;   // of the output
  double initial_velocity_rad_s = 0.0;
  double encoder_counts_per_turn = 0.0;  // of the encoder's shaft; 0: the rig gives angles
  bool encoder_on_output = false;
  std::optional<std::uint64_t> noise_seed;  // for effects that draw random numbers; none: expected values
  // Slaved angle: at each sample where it is finite, the angle that laws look at is set to this measured one
  // (output shaft). Counts, position and speed come from the model's own travel, which is not touched: a
  // small error of speed does not become a wrong phase of cogging. Derivatives take the measured angle as
  // given.
  std::vector<double> measured_position_rad;  // empty: the model's own angle
  std::vector<double>
      restart_velocity_rad_s;  // of the output: where finite, the run starts anew; may be empty
};

struct AxisOptions {
  double step_s = 50e-6;  // at most; each sample period is parted into equal sub-steps
};

template <typename T>
struct AxisSample {
  double time_s = 0.0;
  // as measured (through sensor and timing effects)
  T position_rad = T(0);
  T velocity_rad_s = T(0);
  T encoder_counts = T(0);  // unrounded
  T motor_current_A = T(0);
  T bus_voltage_V = T(0);
  T supply_voltage_V = T(0);  // as the model's supply would give it, also where the bus was measured
  T winding_rise_K = T(0);    // over ambient
  T load_torque_Nm = T(0);
  // true
  T motor_voltage_V = T(0);  // mean over the period that ends at this sample
  T theta_rotor_rad = T(0);
  T omega_rotor_rad_s = T(0);
  T bus_current_A = T(0);
  bool held = false;
};

template <typename T>
std::vector<AxisSample<T>> run_axis(const DriveParams<T>& params, const EffectSet<T>& effects,
                                    const AxisInput& input, const AxisOptions& options = {});

// The same samples handed over in order, none kept: with dual numbers a minute at 1 kHz is 50 MB of them.
template <typename T>
using AxisVisitor = std::function<void(std::size_t k, const AxisSample<T>& sample)>;
template <typename T>
void visit_axis(const DriveParams<T>& params, const EffectSet<T>& effects, const AxisInput& input,
                const AxisOptions& options, const AxisVisitor<T>& visit);

// Of `count` inputs that have nothing to do with one another (settled points) each one's last sample: the same as run_axis() of each,
// without building the drive anew. input(n) may be the same object each time, changed.
template <typename T>
void visit_axis_ends(const DriveParams<T>& params, const EffectSet<T>& effects, std::size_t count,
                     const std::function<const AxisInput&(std::size_t)>& input, const AxisOptions& options,
                     const AxisVisitor<T>& visit);

}  // namespace omnihil
