// A text as it stands in a TOML file.
//
//   toml_text("sheet \"A\"");      // "sheet \"A\"" with its quotes: a basic string
#pragma once
#include <string>
#include <string_view>

namespace omnihil {

std::string toml_text(std::string_view text);

}  // namespace omnihil
