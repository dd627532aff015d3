// Debug information of firmware: whatever is in the file, variables have a place or a reason why not.
#include "hil/variables/debug_info.h"
#include "hil/variables/variable_value.h"
#include "tests/fuzz/fuzz_target.h"

OMNIHIL_FUZZ_TARGET(bytes) {
  using namespace omnihil;
  std::string problem;
  const auto info = DebugInfo::read({bytes.begin(), bytes.end()}, problem);
  demand((info != nullptr) == problem.empty(), "debug information or a problem");
  if (info == nullptr) return;
  const VariableNames names(info, {1, state_bytes_of(*info)});
  for (const DebugVariable& v : info->variables()) {
    std::string why;
    const auto place = names.find(v.name, why);
    demand(place.has_value() == why.empty(), "a place or a reason");
    if (!place) continue;
    for (const VariablePlace& value : names.values_of(*place, 64)) {
      std::vector<std::uint8_t> raw = value.constant;
      if (raw.empty()) raw = info->initial(value.piece.address, value.piece.bytes);
      if (raw.empty()) raw.resize(std::min<std::size_t>(value.piece.bytes, 16));
      const DebugType& type = info->type(value.type);
      demand(!text_of_value(type, value, raw).empty(), "a value has a text");
      value_bytes("1", type, value, raw);
    }
  }
}
