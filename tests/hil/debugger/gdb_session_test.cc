// GDB at running benches: each test is a function of gdb_client.py beside this file.
#include <gtest/gtest.h>

#include "tests/hil/serve/script_outcome.h"

namespace omnihil {
namespace {

SCRIPT_TEST(GdbSession, "debugger/gdb_client.py", a_wheel_follows_its_integral_that_gdb_changes)
SCRIPT_TEST(GdbSession, "debugger/gdb_client.py", a_session_with_halts_passes_the_same_checks)
SCRIPT_TEST(GdbSession, "debugger/gdb_client.py", registers_and_memory_are_read_and_written)
SCRIPT_TEST(GdbSession, "debugger/gdb_client.py", reset_begins_anew)
SCRIPT_TEST(GdbSession, "debugger/gdb_client.py", every_board_is_a_thread_and_all_stand)
SCRIPT_TEST(GdbSession, "debugger/gdb_client.py", time_stands_while_the_host_asks)
SCRIPT_TEST(GdbSession, "debugger/gdb_client.py", a_fault_halts_where_it_happens)
SCRIPT_TEST(GdbSession, "debugger/gdb_client.py", what_cannot_be_debugged_is_said)

SCRIPT_TEST(GdbReverse, "debugger/gdb_reverse_client.py", steps_back_show_the_same_states_and_forward_too)
SCRIPT_TEST(GdbReverse, "debugger/gdb_reverse_client.py", what_was_looked_at_in_the_past_changes_nothing)
SCRIPT_TEST(GdbReverse, "debugger/gdb_reverse_client.py", reverse_continue_finds_the_breakpoints_before)
SCRIPT_TEST(GdbReverse, "debugger/gdb_reverse_client.py", a_watchpoint_is_gone_back_to_before_its_write)
SCRIPT_TEST(GdbReverse, "debugger/gdb_reverse_client.py", without_a_past_it_is_said)

}  // namespace
}  // namespace omnihil
