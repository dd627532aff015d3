// All effects there are, in alphabetical order: one per file of sim/effects/ (the list is CMake's).
//
//   for (const EffectEntry* e : all_effects()) std::cout << e->info->id;
//   const EffectEntry* e = find_effect("coging");   // null; nearest_effect("coging") is "cogging"
#pragma once
#include <span>
#include <string_view>

#include "sim/law/effect_entry.h"

namespace omnihil {

std::span<const EffectEntry* const> all_effects();
const EffectEntry* find_effect(std::string_view id);
std::string_view nearest_effect(std::string_view id);  // "" when none is close
// Index of a parameter among the effect's rows, or -1.
int find_param(const EffectInfo& info, std::string_view name);
std::string_view nearest_param(const EffectInfo& info, std::string_view name);

}  // namespace omnihil
