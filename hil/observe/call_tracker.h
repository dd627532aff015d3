// Which function runs, called by whom, in which interrupt: told from the instructions of an image as they run.
//
//   CallTracker calls(image, machine, [&](const CallEvent& event) { … });
//   machine.observe(&calls);
//
// Nothing of the image is changed: a BL or BLX pushes, coming to the address behind one pops, a jump to another function's
// begin is a call from its place, an exception is a level of its own on which functions stand. Where the image goes
// elsewhere by itself (a task's switch, longjmp) the level begins anew with the function that is there. Functions are the
// symbols of the image; what the compiler inlined belongs to where it is.
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "firmware_iface/mcu/machine/machine.h"

namespace omnihil {

struct CallEvent {
  enum class Kind : std::uint8_t { kEnter, kLeave, kExceptionBegins, kExceptionEnds } kind;
  int which = 0;         // function (CallTracker::function), or exception
  int caller = -1;       // kEnter, kLeave: function that called it; -1: none
  std::int64_t at = 0;   // in 16ths of a cycle
  std::int64_t own = 0;  // kLeave, kExceptionEnds: its time without interrupts, those of its callees included
  std::uint32_t sp = 0;
};

class CallTracker : public mcu::MachineObserver {
 public:
  using Listener = std::function<void(const CallEvent&)>;
  CallTracker(const mcu::ElfImage& image, mcu::Machine& machine, Listener listener);

  void instruction(std::uint32_t pc, const mcu::Op& op, bool met, std::int64_t at) override;
  void exception_begins(int exception, mcu::Cycles at) override;
  void exception_ends(int exception, mcu::Cycles at) override;
  void was_reset(mcu::Cycles at) override;
  void finish(std::int64_t at);  // leaves everything that is open

  // From now on each task of an RTOS has a stack of its own: when another one runs, what is open is left, and what was open in
  // it when it ran last is entered again. `running` names the one that runs by a number.
  void follow_tasks(std::function<std::uint32_t()> running) { running_ = std::move(running); }
  std::uint32_t task() const { return task_; }
  bool in_exception() const { return exceptions_open_ > 0; }

  // Functions that have run, by their number; "?" is code without a symbol.
  const std::vector<std::string>& functions() const { return names_; }
  // Time spent in the function itself (not its callees, no interrupts), and in sleep, in 16ths of a cycle.
  const std::vector<std::int64_t>& self() const { return self_; }
  std::int64_t asleep() const { return asleep_; }
  std::size_t depth() const { return frames_.size(); }

 private:
  struct Frame {
    int function;   // -1: of an exception
    int exception;  // 0: of a function
    std::uint32_t returns_to;
    std::int64_t entered, stolen;  // stolen: by interrupts, while it was there
    std::uint32_t expected = 0;    // of an exception: what was to run next, and whether it was called
    bool call = false;
  };
  struct Suspended {  // a task that does not run
    std::vector<Frame> frames;
    std::uint32_t expected = 0;
    bool call = false;
  };
  struct Symbol {
    std::uint32_t begin;
    int function;  // -1: not met yet
    std::string name;
  };
  void charge(std::int64_t at);
  int function_at(std::uint32_t pc, bool& begins);
  void jumped(std::uint32_t pc, std::int64_t at);
  void enter(int function, std::uint32_t returns_to, std::int64_t at);
  void leave(std::int64_t at);
  void leave_level(std::int64_t at);
  bool task_changed(std::int64_t at);

  mcu::Machine& machine_;
  Listener listener_;
  std::vector<Symbol> symbols_;  // by address
  std::vector<std::string> names_;
  std::vector<std::int64_t> self_;
  std::vector<Frame> frames_;
  std::uint32_t expected_ = 0, sp_ = 0;
  std::int64_t last_ = 0, asleep_ = 0;
  bool call_ = false, branch_ = false, sleeps_ = false, fresh_ = true;
  int unknown_ = -1;
  std::function<std::uint32_t()> running_;
  std::map<std::uint32_t, Suspended> suspended_;
  std::uint32_t task_ = 0;
  int exceptions_open_ = 0;
};

}  // namespace omnihil
