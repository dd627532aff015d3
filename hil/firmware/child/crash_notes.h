// Notes that a crash leaves on the shared page (wire.h): which call, and what kind of address it was about.
//
//   install_crash_notes(page);
//   watch_state(&block);                 // once the state is there
#pragma once
#include "hil/firmware/child/state_block.h"
#include "hil/firmware/wire.h"

namespace omnihil {

// Handles memory faults and stack overflow on a stack of its own, then lets the signal end the process.
void install_crash_notes(WirePage* page);
void watch_state(const StateBlock* block);

}  // namespace omnihil
