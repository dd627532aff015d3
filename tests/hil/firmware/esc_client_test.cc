// Unprepared motor controllers at `omnihil serve`, on one wheel of a robot, told by clients that are not ours (esc_client.py).
#include <gtest/gtest.h>

#include "tests/hil/serve/script_outcome.h"

namespace omnihil {
namespace {

SCRIPT_TEST(EscClient, "firmware/esc_client.py", mini_cheetah_turns_as_python_can_says)
SCRIPT_TEST(EscClient, "firmware/esc_client.py", an_odrive_says_by_pyserial_who_it_is)
SCRIPT_TEST(EscClient, "firmware/esc_client.py", a_vesc_says_by_pyserial_who_it_is)

}  // namespace
}  // namespace omnihil
