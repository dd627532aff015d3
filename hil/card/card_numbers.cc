#include "hil/card/card_numbers.h"

#include <algorithm>
#include <cmath>

namespace omnihil {
namespace {

void set_known(CardNumber& n, const std::optional<double>& tolerance,
               const std::optional<FittedNumber>& fitted) {
  n.kind = tolerance ? "believed" : "exact";
  double sigma = 0.0;
  if (tolerance && n.values.size() == 1) sigma = *tolerance * std::abs(n.values.front());
  if (fitted) {
    n.kind = "fitted";
    n.data = fitted->data;
    n.date = fitted->date;
    sigma = fitted->sigma.value_or(0.0);
  }
  if (n.values.size() != 1 || !(sigma > 0.0)) return;
  const double half = kSigmasOf95Percent * sigma;
  n.interval = {n.values.front() - half, n.values.front() + half};
}

bool has_effect(const Candidate& candidate, std::string_view section) {
  return std::any_of(candidate.effects.begin(), candidate.effects.end(),
                     [&](const EffectUse& use) { return section == "effects." + effect_name(use); });
}

// A further harmonic that stays at zero, or the phase of one: nothing that the file says.
bool is_idle_detail(const EffectUse& use, std::size_t i) {
  const auto& rows = use.entry->info->params;
  const auto detail = [](const EffectParam& row) { return row.role == ParamRole::kDetail; };
  const auto first = static_cast<std::size_t>(std::find_if(rows.begin(), rows.end(), detail) - rows.begin());
  const bool noted = i < use.notes.size() && (!use.notes[i].source.empty() || use.notes[i].fitted);
  return i >= first && use.values[i] == 0.0 && !noted;
}

}  // namespace

std::vector<CardNumber> card_numbers(const Candidate& candidate) {
  std::vector<CardNumber> out;
  for (const Parameter& p : candidate.file.parameters.parameters) {
    const ParameterRow& row = *p.row;
    // Coulomb friction is a row of the table and an effect: it is listed as an effect.
    if (row.section.empty() || has_effect(candidate, row.section)) continue;
    CardNumber& n = out.emplace_back();
    n.path = parameter_path(row);
    n.what = row.what;
    n.source = p.source;
    if (is_text(row)) {
      n.text = p.text;
    } else {
      n.values = p.values;
      n.unit = row.unit;
    }
    if (p.origin == Origin::kDefault) {
      n.kind = "default";
    } else if (is_text(row)) {
      n.kind = "exact";
    } else {
      set_known(n, p.tolerance, p.fitted);
    }
  }
  return out;
}

std::vector<CardEffect> card_effects(const Candidate& candidate) {
  const std::vector<Unknown> unknowns = unknowns_of(candidate);  // they know the units of a linear axis
  std::vector<CardEffect> out;
  for (const EffectUse& use : candidate.effects) {
    CardEffect& effect = out.emplace_back();
    effect.name = effect_name(use);
    effect.title = use.entry->info->title;
    for (std::size_t i = 0; i < use.values.size() && i < use.entry->info->params.size(); ++i) {
      const EffectParam& row = use.entry->info->params[i];
      if (is_idle_detail(use, i)) continue;
      CardNumber& n = effect.numbers.emplace_back();
      n.path = effect.name + "." + std::string(row.name);
      n.unit = row.unit;
      const auto unknown =
          std::find_if(unknowns.begin(), unknowns.end(), [&](const Unknown& u) { return u.path == n.path; });
      if (unknown != unknowns.end()) n.unit = unknown->unit;
      n.what = row.what;
      n.values = {use.values[i]};
      if (i < use.notes.size()) n.source = use.notes[i].source;
      static const std::optional<double> kNoTolerance;
      static const std::optional<FittedNumber> kNoFit;
      set_known(n, i < use.tolerances.size() ? use.tolerances[i] : kNoTolerance,
                i < use.notes.size() ? use.notes[i].fitted : kNoFit);
    }
  }
  return out;
}

}  // namespace omnihil
