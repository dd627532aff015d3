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

}  // namespace
}  // namespace omnihil
