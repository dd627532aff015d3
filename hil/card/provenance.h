// Licence and source of a dataset, as its folder states them: lines of README.md, and the first line of LICENSE.
//
//   Provenance p = provenance_of("data/qube_servo");
//   p.licence;                     // "MIT."; empty: not stated
//
// Of a README what stands behind "Licence:" or "License:" ("Source:") is taken, up to the end of the line or the
// next such word. Cannot: judge whether it is true, or whether files of one folder differ.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>

namespace omnihil {

struct Provenance {
  std::string licence, source;
  std::string readme;  // all of it, at most 20 kB
};

Provenance provenance_of(const std::filesystem::path& folder);

// What stands behind "Licence:" or "License:" in a text; "source" likewise.
std::string stated_in(std::string_view text, std::string_view word);

}  // namespace omnihil
