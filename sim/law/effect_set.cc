#include "sim/law/effect_set.h"

#include <algorithm>
#include <cassert>

#include "sim/law/drive_params.h"
#include "sim/law/effect_registry.h"
#include "sim/law/linear_scale.h"

namespace omnihil {
namespace {

template <typename T>
bool absent(const EffectInfo& info, std::span<const T> values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    const EffectParam& row = info.params[i];
    if (row.role != ParamRole::kShape && !is_exactly(values[i], row.neutral)) return false;
  }
  return true;
}

}  // namespace

double start_of(const EffectParam& row, const DriveParams<double>* drive) {
  if (row.start_for != nullptr && drive != nullptr)
    return std::clamp(row.start_for(*drive), row.lower, row.upper);
  const bool linear_speed = drive != nullptr && drive->linear && row.unit == "rad/s";
  return linear_speed ? row.typical * kTravelOverAngle_m_per_rad : row.typical;
}

EffectUse neutral_use(const EffectEntry& entry, const DriveParams<double>* drive, std::size_t wheels) {
  EffectUse use{.entry = &entry, .values = {}, .tolerances = {}, .name = {}, .owner = {}};
  for (const EffectParam& row : rows_of(*entry.info, wheels)) {
    use.values.push_back(row.role == ParamRole::kShape ? start_of(row, drive) : row.neutral);
  }
  return use;
}

EffectUse typical_use(const EffectEntry& entry, const DriveParams<double>* drive, std::size_t wheels) {
  EffectUse use{.entry = &entry, .values = {}, .tolerances = {}, .name = {}, .owner = {}};
  for (const EffectParam& row : rows_of(*entry.info, wheels)) {
    use.values.push_back(row.role == ParamRole::kDetail ? row.neutral : start_of(row, drive));
  }
  return use;
}

bool is_neutral(const EffectUse& use) { return absent<double>(*use.entry->info, use.values); }

template <typename T>
std::vector<T> law_params(const EffectEntry& entry, std::span<const T> values) {
  std::vector<T> params(values.begin(), values.end());
  params.resize(values.size() + static_cast<std::size_t>(entry.derived));
  if (entry.derived > 0) entry.functions<T>().prepare(params.data(), params.data() + values.size());
  return params;
}

template <typename T>
EffectSet<T>::EffectSet(std::span<const EffectUse> uses) {
  std::vector<T> values;
  for (const EffectUse& use : uses) {
    for (const double v : use.values) values.push_back(T(v));
  }
  *this = EffectSet(uses, values);
}

template <typename T>
EffectSet<T>::EffectSet(std::span<const EffectUse> uses, std::span<const T> values) {
  struct Active {
    const EffectEntry* entry;
    std::vector<T> values;
  };
  std::vector<Active> active;
  std::size_t first = 0;
  for (const EffectUse& use : uses) {
    if (use.owner != nullptr) owners_.push_back(use.owner);
    const auto own = values.subspan(first, use.values.size());
    first += own.size();
    const bool wanted = std::any_of(uses.begin(), uses.end(), [&](const EffectUse& other) {
      return other.entry->info->needs == use.entry->info->id;
    });
    if (wanted || !absent(*use.entry->info, own)) active.push_back({use.entry, {own.begin(), own.end()}});
  }
  // What an active effect reads must run along.
  for (std::size_t i = 0; i < active.size(); ++i) {
    const std::string_view needs = active[i].entry->info->needs;
    const bool there = std::any_of(active.begin(), active.end(),
                                   [&](const Active& a) { return a.entry->info->id == needs; });
    if (needs.empty() || there) continue;
    const EffectEntry* entry = find_effect(needs);
    assert(entry != nullptr);
    Active extra{entry, {}};
    for (const double v : neutral_use(*entry).values) extra.values.push_back(T(v));
    active.push_back(extra);
  }
  std::stable_sort(active.begin(), active.end(),
                   [](const Active& a, const Active& b) { return a.entry->info->id < b.entry->info->id; });
  // Within a place, what others read comes first.
  std::stable_partition(active.begin(), active.end(), [&](const Active& a) {
    return std::any_of(active.begin(), active.end(),
                       [&](const Active& b) { return b.entry->info->needs == a.entry->info->id; });
  });
  for (const Active& a : active) add(*a.entry, a.values);
}

template <typename T>
void EffectSet<T>::add(const EffectEntry& entry, std::span<const T> values) {
  const int first_param = static_cast<int>(values_.size());
  const int first_state = static_cast<int>(initial_states_.size());
  std::vector<T> given(values.begin(), values.end());
  // A law finds its rows where they always are: wheels that the robot lacks are as the model has them.
  for (const EffectParam& row : entry.info->params.subspan(given.size())) given.push_back(T(row.neutral));
  const std::vector<T> params = law_params<T>(entry, given);
  values_.insert(values_.end(), params.begin(), params.end());
  for (const EffectState& state : entry.info->states) initial_states_.push_back(T(state.initial));
  assert(initial_states_.size() <= kMaxEffectStates);
  const auto link = [&](auto function, auto& chain) {
    if (function != nullptr) chain.links.push_back({function, entry.context, first_param, first_state});
    return function != nullptr ? 1 : 0;
  };
  const ApplyFunctions<T>& f = entry.functions<T>();
  const int in_drive = link(f.command, command) + link(f.supply, supply) + link(f.bridge, bridge) +
                       link(f.winding, winding) + link(f.torque, torque) + link(f.shaft, shaft);
  active_in_drive_ += in_drive;
  reads_motor_torque_ =
      reads_motor_torque_ || (f.torque != nullptr && (entry.info->numerics & kReadsMotorTorque) != 0);
  bridge_reads_current_ =
      bridge_reads_current_ || (f.bridge != nullptr && (entry.info->numerics & kReadsCurrent) != 0);
  active_ += in_drive + link(f.contact, contact) + link(f.body, body) + link(f.sensor, sensor) +
             link(f.timing, timing);
}

template std::vector<double> law_params(const EffectEntry&, std::span<const double>);
template std::vector<Jet> law_params(const EffectEntry&, std::span<const Jet>);
template class EffectSet<double>;
template class EffectSet<Jet>;

}  // namespace omnihil
