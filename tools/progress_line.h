// How far a long piece of work is, on one line of a terminal, with the time that is left; silent elsewhere,
// or, where lines are asked for, one line for each thing done, with the time since the start.
//
//   ProgressLine line;                       // on stderr
//   line.show("refitting cogging", 0.4);     //  40 %  refitting cogging, about 12 s left
//   ProgressLine lines(true);
//   lines.show("refitting cogging", 0.4);    // "    8.1 s   40 %  refitting cogging", and a new line
//
// Cannot: know of pieces that take longer than their share; the estimate is the time so far over the share so
// far.
#pragma once
#include <chrono>
#include <string>

namespace omnihil {

class ProgressLine {
 public:
  explicit ProgressLine(bool as_lines = false);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void show(const std::string& doing, double share);
  double elapsed_s() const;

 private:
  void clear();

  std::chrono::steady_clock::time_point start_;
  std::chrono::steady_clock::time_point shown_;
  std::string last_;  // what was shown as a line
  bool terminal_ = false;
  bool as_lines_ = false;
  bool written_ = false;
};

}  // namespace omnihil
