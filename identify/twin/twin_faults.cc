#include "identify/twin/twin_faults.h"

#include <fmt/format.h>

#include <cmath>

#include "sim/law/effect_entry.h"
#include "sim/law/effect_registry.h"
#include "sim/model/rolling_model.h"
#include "sim/robot/geometry.h"

namespace omnihil {
namespace {

// Bounds and typical sizes are nobody's: no fit and no search sees these two.
#define WHEEL(k)                                                         \
  {                                                                      \
    .name = "wheel_" #k, .unit = "1", .lower = -1, .upper = 1,           \
    .what = "share added to wheel " #k "'s torque", .how = "no fit does" \
  }
struct WheelTorque {
  static constexpr EffectParam kParams[] = {WHEEL(1), WHEEL(2), WHEEL(3), WHEEL(4)};
  static constexpr EffectInfo kInfo{.id = "wheel_torque",
                                    .title = "Torque of one wheel",
                                    .equation = "k_t = (1 + t_k) k_t, back-EMF as before",
                                    .source = "a fault, not an effect",
                                    .cannot = "be searched for",
                                    .place = Place::kWinding,
                                    .reveals = "the live twin",
                                    .visible = "the live twin says",
                                    .rigs = kOnRobot,
                                    .params = kParams};
  template <typename T>
  static void apply(const T* p, T*, WindingPort<T>& port) {
    port.torque_constant_Nm_per_A *= 1.0 + p[port.wheel];
  }
};
#undef WHEEL

#define WHEEL(k)                                                                                 \
  {                                                                                              \
    .name = "wheel_" #k "_Nm", .unit = "N m", .upper = 1, .what = "friction added at wheel " #k, \
    .how = "no fit does"                                                                         \
  }
struct WheelDrag {
  static constexpr EffectParam kParams[] = {WHEEL(1), WHEEL(2), WHEEL(3), WHEEL(4)};
  static constexpr EffectInfo kInfo{.id = "wheel_drag",
                                    .title = "Drag of one wheel",
                                    .equation = "a friction level more at wheel k",
                                    .source = "a fault, not an effect",
                                    .cannot = "be searched for",
                                    .place = Place::kContact,
                                    .reveals = "the live twin",
                                    .visible = "the live twin says",
                                    .rigs = kOnRobot,
                                    .params = kParams};
  template <typename T>
  static void apply(const T* p, T*, ContactPort<T>& port) {
    port.friction_wheel_Nm += p[port.wheel];
  }
};
#undef WHEEL

OMNIHIL_EFFECT(wheel_torque, WheelTorque)
OMNIHIL_EFFECT(wheel_drag, WheelDrag)

// Sizes: half of what a team would call broken (a fifth of a wheel's torque, twice a wheel's own friction, the sag of a battery
// that is due, a fifth of the mass, a packet period); choices.
constexpr double kLeastTorque = -0.1, kLeastDrag_Nm = 0.008, kLeastSag_ohm = 0.05, kLeastMass_kg = 0.25,
                 kLeastLate_s = 0.008;  // choices, as above

class Maker {
 public:
  explicit Maker(TwinBank& bank) : bank_(bank) {}

  void row(const EffectEntry& entry, std::size_t row, TwinFault fault) {
    const int effect = place_of(entry);
    const EffectUse& use = bank_.model.effects[static_cast<std::size_t>(effect)];
    const EffectParam& param = entry.info->params[row];
    fault.unknown = {.path = std::string(entry.info->id) + "." + std::string(param.name),
                     .unit = std::string(param.unit),
                     .effect = effect,
                     .row = static_cast<int>(row),
                     .start = use.values[row]};
    fault.unit = fault.percent ? "%" : fault.unknown.unit;
    bank_.faults.push_back(std::move(fault));
  }

  void base(const char* path, TwinFault fault) {
    const Parameter* p = bank_.model.file.parameters.find(path);
    if (p == nullptr) return;
    fault.unknown = {.path = path, .unit = fault.unit};
    bank_.faults.push_back(std::move(fault));
  }

 private:
  int place_of(const EffectEntry& entry) {
    const auto& effects = bank_.model.effects;
    for (std::size_t e = 0; e < effects.size(); ++e) {
      if (effects[e].entry->info->id == entry.info->id) return static_cast<int>(e);
    }
    bank_.model = with_effect(bank_.model, entry);
    for (std::size_t e = 0; e < effects.size(); ++e) {
      if (effects[e].entry->info->id == entry.info->id) return static_cast<int>(e);
    }
    return -1;
  }
  TwinBank& bank_;
};

}  // namespace

std::string TwinFault::size_text(double size, double sigma) const {
  const double scale = percent ? 100.0 : 1.0, half = 1.96 * sigma;
  const auto signed_text = [&](double v) { return fmt::format("{:+.2g}", scale * v); };
  return fmt::format("{} {} ({} to {})", signed_text(size), unit, signed_text(size - half),
                     signed_text(size + half));
}

std::vector<Unknown> TwinBank::unknowns() const {
  std::vector<Unknown> out;
  for (const TwinFault& f : faults) out.push_back(f.unknown);
  return out;
}

TwinBank twin_bank(const Candidate& model) {
  TwinBank bank{.model = model, .faults = {}};
  Maker make(bank);
  const std::size_t wheels = wheel_count(model.file.parameters);
  for (const bool magnets : {false, true}) {
    for (std::size_t i = 0; i < wheels; ++i) {
      make.row(magnets ? *find_effect("motor_mismatch") : effect_wheel_torque(), i,
               {.id = fmt::format("wheel_{}_{}", magnets ? "magnets" : "torque", i + 1),
                .suspect = fmt::format("torque of wheel {}", i + 1),
                .unknown = {},
                .least = kLeastTorque,
                .percent = true,
                .unit = {}});
    }
  }
  for (std::size_t i = 0; i < wheels; ++i) {
    make.row(effect_wheel_drag(), i,
             {.id = fmt::format("wheel_drag_{}", i + 1),
              .suspect = fmt::format("drag on wheel {}", i + 1),
              .unknown = {},
              .least = kLeastDrag_Nm,
              .unit = {}});
  }
  make.row(
      *find_effect("battery_sag"), 0,
      {.id = "battery_sag", .suspect = "sagging battery", .unknown = {}, .least = kLeastSag_ohm, .unit = {}});
  make.row(
      *find_effect("payload"), 0,
      {.id = "payload", .suspect = "more mass to move", .unknown = {}, .least = kLeastMass_kg, .unit = {}});
  make.base(
      "controller.latency_s",
      {.id = "radio_latency", .suspect = "late commands", .unknown = {}, .least = kLeastLate_s, .unit = "s"});
  return bank;
}

}  // namespace omnihil
