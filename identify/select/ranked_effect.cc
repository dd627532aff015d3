#include "identify/select/ranked_effect.h"

namespace omnihil {

std::string_view accepted_by_name(AcceptedBy by) {
  switch (by) {
    case AcceptedBy::kNone:
      return "";
    case AcceptedBy::kGain:
      return "gain";
    case AcceptedBy::kPrior:
      return "prior";
    case AcceptedBy::kNoise:
      return "noise";
  }
  return "";
}

}  // namespace omnihil
