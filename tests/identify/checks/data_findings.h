// What data checks found, as tests look at it.
#pragma once
#include <algorithm>
#include <string>
#include <vector>

#include "identify/select/diagnosis.h"

namespace omnihil {

using Grade = DataFinding::Grade;

inline std::string text_of(const std::vector<DataFinding>& findings) {
  std::string text;
  for (const DataFinding& f : findings) {
    const char* grade = f.grade == Grade::kFault ? "fault" : (f.grade == Grade::kDoubt ? "doubt" : "note");
    text += std::string(grade) + " " + f.kind + " [" + f.signal + "]: " + f.sentence + "\n";
  }
  return text;
}

inline const DataFinding* find(const std::vector<DataFinding>& findings, const std::string& kind) {
  const auto found =
      std::find_if(findings.begin(), findings.end(), [&](const DataFinding& f) { return f.kind == kind; });
  return found == findings.end() ? nullptr : &*found;
}

inline int count(const std::vector<DataFinding>& findings, Grade least) {
  return static_cast<int>(std::count_if(findings.begin(), findings.end(),
                                        [&](const DataFinding& f) { return f.grade >= least; }));
}

}  // namespace omnihil
