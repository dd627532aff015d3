#include "hil/firmware/child/crash_notes.h"

#include <sys/resource.h>

#include <array>
#include <csignal>

namespace omnihil {
namespace {

WirePage* notes = nullptr;
const StateBlock* state = nullptr;
std::uintptr_t stack_top = 0, stack_bytes = 0;
std::array<std::uint8_t, 64 * 1024> own_stack;

constexpr std::uintptr_t kNullPage = 64 * 1024;  // a member of a null pointer to a struct of this size
constexpr std::uintptr_t kStackEnd_bytes = 1024 * 1024;  // beyond the limit, still the stack's doing

void note(int signal, siginfo_t* info, void*) {
  const auto address = reinterpret_cast<std::uintptr_t>(info->si_addr);
  // si_code <= 0: raised by a program, and there is no address
  const bool memory = (signal == SIGSEGV || signal == SIGBUS) && info->si_code > 0;
  if (memory) {
    const auto offset = state != nullptr ? state->offset_of(info->si_addr) : std::nullopt;
    const std::uintptr_t lowest = stack_top - stack_bytes;
    if (offset) {
      notes->crash = CrashKind::kState;
      notes->offset_bytes = *offset;
      notes->state_bytes = static_cast<std::int64_t>(state->bytes());
    } else if (address < kNullPage) {
      notes->crash = CrashKind::kNull;
      notes->offset_bytes = static_cast<std::int64_t>(address);
    } else if (address < lowest + kStackEnd_bytes && address > lowest - kStackEnd_bytes) {
      notes->crash = CrashKind::kStack;
    } else {
      notes->crash = CrashKind::kElsewhere;
    }
  }
  std::signal(signal, SIG_DFL);
  std::raise(signal);  // delivered when this handler returns
}

}  // namespace

void install_crash_notes(WirePage* page) {
  notes = page;
  int here = 0;
  stack_top = reinterpret_cast<std::uintptr_t>(&here);
  rlimit limit{};
  ::getrlimit(RLIMIT_STACK, &limit);
  stack_bytes = limit.rlim_cur == RLIM_INFINITY ? 0 : limit.rlim_cur;
  stack_t alternative{};
  alternative.ss_sp = own_stack.data();
  alternative.ss_size = own_stack.size();
  ::sigaltstack(&alternative, nullptr);
  struct sigaction action {};
  action.sa_sigaction = note;
  action.sa_flags = SA_SIGINFO | SA_ONSTACK;
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) ::sigaction(signal, &action, nullptr);
}

void watch_state(const StateBlock* block) { state = block; }

}  // namespace omnihil
