#include "sim/pages/effect_page.h"

#include <fmt/format.h>

#include <cmath>

#include "sim/law/effect_registry.h"
#include "sim/model/effect_reader.h"

namespace omnihil {
namespace {

constexpr std::size_t kUsualWheels = 4;  // of the robot in an example: a choice

std::string rigs_of(const EffectInfo& info) {
  if (info.rigs == kOnBoth) return "axis, robot";
  return info.rigs == kOnAxis ? "axis" : "robot";
}

// What a rig must have for it (sim/law/demands.h), and the base parameter beside which it has no place.
std::string needs_of(const EffectInfo& info) {
  std::string out;
  std::uint32_t demands = demands_of(info);
  if ((demands & kNeedsDuty) != 0) demands &= ~static_cast<std::uint32_t>(kNeedsWinding);  // which has one
  for (int bit = 0; bit < kDemands; ++bit) {
    if ((demands >> bit & 1u) == 0) continue;
    out += (out.empty() ? "" : "; ") + std::string(demand_name(static_cast<DemandBit>(1u << bit)));
  }
  if (info.of_angle != LawOfAngle::kNone)
    out += (out.empty() ? "" : "; ") + std::string("on a robot: encoders");
  out = fmt::format("Needs: {}.", out.empty() ? "nothing in particular" : out);
  const auto& [path, when] = info.excludes;
  if (path.empty()) return out;
  return out + fmt::format(" Left out where the base model's `{}` {}, which does the same.", path,
                           when == BaseExclusion::kWhereFree ? "has a tolerance" : "is not 0");
}

std::string claims_of(const EffectInfo& info) {
  std::string out;
  const auto add = [&](std::uint32_t bit, const char* text) {
    if ((info.claims & bit) != 0) out += fmt::format("- {}\n", text);
  };
  add(kDissipative, "never adds energy");
  add(kOdd, "everything reversed, it is reversed");
  add(kConservative, "does no work over a turn");
  add(kRandom, "draws random numbers: the same for the same seed");
  add(kFlatAtNeutral,
      "at neutral no signal changes with it to first order: a fit needs a start away from neutral");
  return out;
}

std::string role_of(const EffectParam& row) {
  return row.role == ParamRole::kShape ? "(shape)" : fmt::format("{:g}", row.neutral);
}

bool is_detail(const EffectInfo& info, std::size_t i) {
  return info.params[i].role == ParamRole::kDetail ||
         (i > 0 && info.params[i].role == ParamRole::kShape && info.params[i - 1].role == ParamRole::kDetail);
}

std::string params_of(const EffectInfo& info) {
  std::string out =
      "| parameter | unit | neutral | typical | allowed | what | how to measure it "
      "|\n|---|---|---|---|---|---|---|\n";
  std::size_t details = 0;
  for (std::size_t i = 0; i < info.params.size(); ++i) {
    const EffectParam& row = info.params[i];
    if (is_detail(info, i) && ++details > 2) continue;  // the others are like the first pair
    out += fmt::format("| `{}` | {} | {} | {:g} | {:g} to {:g} | {} | {} |\n", row.name, row.unit,
                       role_of(row), row.typical, row.lower, row.upper, row.what, row.how);
  }
  if (details > 2) {
    out += fmt::format("\nAnd so on up to `{}`, `{}`.\n", info.params[info.params.size() - 2].name,
                       info.params.back().name);
  }
  if (!info.params.empty() && info.params.back().wheel > 0)
    out += "\nOf a robot of n wheels the rows of wheels 1 to n; another one in its file is an error.\n";
  return out;
}

std::string twins_of(const EffectInfo& info) {
  std::string out;
  for (const std::string_view twin : info.twins) {
    if (twin.empty()) continue;
    const bool effect = twin.find('.') == std::string_view::npos;
    out += (out.empty() ? "" : ", ") +
           (effect ? fmt::format("[`{}`]({}.md)", twin, twin) : fmt::format("`{}`", twin));
  }
  return out.empty() ? "none known" : out;
}

std::string visible_of(const EffectInfo& info) {
  if (info.min_visible == nullptr) return fmt::format("{}.", info.visible);
  const SensorSet s;
  return fmt::format(
      "{}. About {:.2g} {} with {:g} counts per turn, {:g} Hz, {:g} A and {:g} V of noise over {:g} s.",
      info.visible, info.min_visible(s), info.params[first_strength(info)].unit, s.counts_per_turn, s.rate_Hz,
      s.current_sigma_A, s.voltage_sigma_V, s.duration_s);
}

}  // namespace

DriveParams<double> demonstration_drive() {
  DriveParams<double> p;
  p.resistance_ohm = 1.2;  // data sheet of order number 200142
  p.inductance_H = 5.6e-4;
  p.torque_constant_Nm_per_A = 0.0255;
  p.rotor_inertia_kg_m2 = 9.25e-6;
  p.viscous_friction_Nm_s_per_rad = 5e-6;  // guess, +-50 %
  p.load_inertia_kg_m2 = 2e-5;
  p.supply_voltage_V = 12.0;
  p.pole_pairs = 8;
  p.servo_kp_duty_per_rad = 2.0;  // a choice: some 0.1 s to settle
  p.slots = 12;                   // guess: a common choice with 16 poles
  return p;
}

std::string effect_page(const EffectEntry& entry) {
  const EffectInfo& info = *entry.info;
  std::string out = fmt::format("# {}\n\n`{}` acts on: {}. Rigs: {}.\n\n{}\n\n", info.title, info.id,
                                place_name(info.place), rigs_of(info), needs_of(info));
  out += fmt::format("```\n{}\n```\n\nSource: {}.\n\nCannot: {}.\n\n## Parameters\n\n{}\n", info.equation,
                     info.source, info.cannot, params_of(info));
  out +=
      fmt::format("At the neutral values the effect is exactly absent: results are equal bit for bit.\n\n");
  out += fmt::format("## How to see it\n\n{}.\n\nSmallest size: {}\n\nCan be mistaken for: {}.\n\n",
                     info.reveals, visible_of(info), twins_of(info));
  if (!info.needs.empty()) {
    out += fmt::format("It reads what [`{0}`]({0}.md) models, which runs along with it.\n\n", info.needs);
  }
  if ((info.rigs & kOnAxis) != 0) {
    out +=
        fmt::format("![{} against {}, with and without](img/{}.svg)\n\n", info.plot.y, info.plot.x, info.id);
  }
  const std::string claims = claims_of(info);
  if (!claims.empty()) out += "Tested for it:\n\n" + claims + "\n";
  const DriveParams<double> drive = demonstration_drive();
  const std::vector<EffectUse> uses{typical_use(entry, &drive, kUsualWheels)};
  const EffectParam& row = info.params[first_strength(info)];
  out +=
      fmt::format("## In a model file\n\n```toml{}```\n\nOn a command line: `--with {}.{}={:g}`\n",
                  write_effects(uses, false), info.id, row.name, uses.front().values[first_strength(info)]);
  return out;
}

std::string effect_index() {
  std::string out = "| effect | place | what | can be mistaken for |\n|---|---|---|---|\n";
  for (const EffectEntry* e : all_effects()) {
    out += fmt::format("| [`{0}`]({0}.md) | {1} | {2} | {3} |\n", e->info->id, place_name(e->info->place),
                       e->info->title, twins_of(*e->info));
  }
  return out;
}

}  // namespace omnihil
