// What a misspelt word probably meant.
//
//   const std::string_view known[] = {"cogging", "backlash"};
//   nearest_spelling("coging", known);   // "cogging"
#pragma once
#include <span>
#include <string_view>

namespace omnihil {

// The closest of `candidates` to a misspelt word, or "" when none is close (Levenshtein distance of at most a
// third of the word, at least 2).
std::string_view nearest_spelling(std::string_view word, std::span<const std::string_view> candidates);

}  // namespace omnihil
