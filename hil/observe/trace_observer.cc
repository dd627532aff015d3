#include "hil/observe/trace_observer.h"

namespace omnihil {

bool passes_filter(const std::string& filter, std::string_view name) {
  if (filter.empty()) return true;
  for (std::size_t from = 0; from <= filter.size();) {
    const std::size_t comma = std::min(filter.find(',', from), filter.size());
    const std::string_view part = std::string_view(filter).substr(from, comma - from);
    if (!part.empty() && name.find(part) != std::string_view::npos) return true;
    from = comma + 1;
  }
  return false;
}

}  // namespace omnihil
