// Signals over time as a value change dump (IEEE 1364-2005, clause 18), for GTKWave, PulseView and sigrok-cli.
//
//   write(vcd_text(log));
//
// Levels are wires, words registers of their width, numbers integers and reals. In steps of 1 ns from the log's first instant
// on. PulseView knows a wire by its own name alone, so that of several boards the scope's is put before it; with libsigrok up to
// 0.5.2 it stops at the first word or number (TraceOptions::levels_only leaves them out).
#pragma once
#include <string>

#include "hil/observe/wave_log.h"

namespace omnihil {

std::string vcd_text(const WaveLog& log);

}  // namespace omnihil
