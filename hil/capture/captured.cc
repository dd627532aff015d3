#include "hil/capture/captured.h"

#include <algorithm>

namespace omnihil {

void CaptureNotes::count(const std::string& what, std::size_t place) {
  auto at = std::ranges::find(kinds_, what, &Kind::what);
  if (at == kinds_.end()) at = kinds_.insert(at, {what, place, 0});
  ++at->count;
}

void CaptureNotes::say(const std::string& what) {
  if (std::ranges::find(kinds_, what, &Kind::what) == kinds_.end()) kinds_.push_back({what, 0, 0});
}

std::vector<std::string> CaptureNotes::list() const {
  std::vector<std::string> lines;
  for (const Kind& kind : kinds_) {
    std::string line = name_;
    if (kind.count > 0) line += ":" + place_ + std::to_string(kind.first);
    line += ": " + kind.what;
    if (kind.count > 1) line += " (and " + std::to_string(kind.count - 1) + " more of it)";
    lines.push_back(line);
  }
  return lines;
}

void sort_by_time(Capture& capture, CaptureNotes& notes) {
  std::size_t back = 0;
  for (std::size_t i = 1; i < capture.pieces.size(); ++i)
    back += capture.pieces[i].at_ns < capture.pieces[i - 1].at_ns ? 1 : 0;
  if (back == 0) return;
  std::ranges::stable_sort(capture.pieces, {}, &Captured::at_ns);
  notes.say("time goes backwards " + std::to_string(back) + " times: sorted by time");
}

}  // namespace omnihil
