#include "hil/observe/call_tracker.h"

#include <algorithm>

namespace omnihil {

using mcu::kSubcycles;

CallTracker::CallTracker(const mcu::ElfImage& image, mcu::Machine& machine, Listener listener)
    : machine_(machine), listener_(std::move(listener)) {
  for (const auto& [address, name] : image.functions) symbols_.push_back({address, -1, name});
}

// What has passed since the last look belongs to what ran then.
void CallTracker::charge(std::int64_t at) {
  const std::int64_t spent = at - last_;
  last_ = at;
  if (sleeps_) {
    asleep_ += spent;
  } else if (!frames_.empty() && frames_.back().function >= 0) {
    self_[static_cast<std::size_t>(frames_.back().function)] += spent;
  }
}

int CallTracker::function_at(std::uint32_t pc, bool& begins) {
  auto after = std::ranges::upper_bound(symbols_, pc, {}, &Symbol::begin);
  const auto number = [this](int& known, const std::string& name) {
    if (known < 0) {
      known = static_cast<int>(names_.size());
      names_.push_back(name);
      self_.push_back(0);
    }
    return known;
  };
  begins = false;
  if (after == symbols_.begin()) return number(unknown_, "?");
  --after;
  begins = after->begin == pc;
  return number(after->function, after->name);
}

void CallTracker::enter(int function, std::uint32_t returns_to, std::int64_t at) {
  const int caller = frames_.empty() ? -1 : frames_.back().function;
  frames_.push_back({function, 0, returns_to, at, 0, 0, false});
  listener_({CallEvent::Kind::kEnter, function, caller, at, 0, sp_});
}

void CallTracker::leave(std::int64_t at) {
  const Frame frame = frames_.back();
  frames_.pop_back();
  const std::int64_t own = at - frame.entered - frame.stolen;
  if (frame.exception != 0) {
    --exceptions_open_;
    if (!frames_.empty()) frames_.back().stolen += at - frame.entered;
    listener_({CallEvent::Kind::kExceptionEnds, frame.exception, -1, at, own, sp_});
    return;
  }
  const int caller = frames_.empty() ? -1 : frames_.back().function;
  if (!frames_.empty()) frames_.back().stolen += frame.stolen;
  listener_({CallEvent::Kind::kLeave, frame.function, caller, at, own, sp_});
}

// The functions of the innermost exception, or of the thread.
void CallTracker::leave_level(std::int64_t at) {
  while (!frames_.empty() && frames_.back().exception == 0) leave(at);
}

// Of the thread level; the new task goes on where it was left.
bool CallTracker::task_changed(std::int64_t at) {
  if (!running_ || in_exception()) return false;
  const std::uint32_t next = running_();
  if (next == task_) return false;
  Suspended& old = suspended_[task_];
  old = {frames_, expected_, call_};
  while (!frames_.empty()) leave(at);
  task_ = next;
  const Suspended again = std::exchange(suspended_[next], {});
  for (const Frame& frame : again.frames) enter(frame.function, frame.returns_to, at);
  expected_ = again.expected;
  call_ = again.call;
  return true;
}

void CallTracker::jumped(std::uint32_t pc, std::int64_t at) {
  if (task_changed(at) && !frames_.empty() && pc == expected_ && !call_) return;
  bool begins = false;
  const int function = function_at(pc, begins);
  if (call_) return enter(function, expected_, at);
  for (std::size_t i = frames_.size();
       i-- > 0 && frames_[i].exception == 0;) {  // a return, of one or of several
    if (frames_[i].returns_to != pc) continue;
    while (frames_.size() > i) leave(at);
    if (frames_.empty() || frames_.back().function != function) enter(function, 0, at);
    return;
  }
  if (!frames_.empty() && frames_.back().function == function) return;  // within it
  if ((begins || branch_) && !frames_.empty() &&
      frames_.back().exception == 0) {  // a call in the place of a return
    const std::uint32_t returns_to = frames_.back().returns_to;
    leave(at);
    return enter(function, returns_to, at);
  }
  leave_level(at);
  enter(function, 0, at);
}

void CallTracker::instruction(std::uint32_t pc, const mcu::Op& op, bool met, std::int64_t at) {
  charge(at);
  if (pc != expected_ || call_ || fresh_) {
    sp_ = machine_.cpu().reg.r[13];
    jumped(pc, at);
    fresh_ = false;
  }
  expected_ = pc + 2u * op.halfwords;
  call_ = met && (op.code == mcu::kBl || op.code == mcu::kBlx);
  branch_ = op.code == mcu::kB || op.code == mcu::kBcond || op.code == mcu::kCbz || op.code == mcu::kCbnz ||
            op.code == mcu::kTbb || op.code == mcu::kTbh;
  sleeps_ = op.code == mcu::kWfi || op.code == mcu::kWfe;
}

void CallTracker::exception_begins(int exception, mcu::Cycles at) {
  const auto now = static_cast<std::int64_t>(at) * kSubcycles;
  charge(now);
  sp_ = machine_.cpu().reg.r[13];
  frames_.push_back({-1, exception, 0, now, 0, expected_, call_});
  ++exceptions_open_;
  listener_({CallEvent::Kind::kExceptionBegins, exception, -1, now, 0, sp_});
  call_ = branch_ = sleeps_ = false;
  fresh_ = true;
}

void CallTracker::exception_ends(int exception, mcu::Cycles at) {
  const auto now = static_cast<std::int64_t>(at) * kSubcycles;
  charge(now);
  const auto is_it = [exception](const Frame& frame) { return frame.exception == exception; };
  call_ = branch_ = sleeps_ = false;
  if (std::ranges::any_of(frames_, is_it)) {
    while (!is_it(frames_.back())) leave(now);
    expected_ = frames_.back().expected;
    call_ = frames_.back().call;
    leave(now);
  }
  // Back in the middle of what was interrupted: no jump, unless the image has gone elsewhere meanwhile.
  fresh_ = true;
}

void CallTracker::was_reset(mcu::Cycles at) { finish(static_cast<std::int64_t>(at) * kSubcycles); }

void CallTracker::finish(std::int64_t at) {
  charge(std::max(at, last_));
  while (!frames_.empty()) leave(last_);
  call_ = branch_ = sleeps_ = false;
  fresh_ = true;
}

}  // namespace omnihil
