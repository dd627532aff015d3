// Clients in Python at a running `omnihil serve`: each test is a function of a script beside this file.
#include "tests/hil/serve/script_outcome.h"

namespace omnihil {
namespace {

SCRIPT_TEST(ServeTest, "serve/serial_client.py", drives_a_robot_through_the_serial_port)
SCRIPT_TEST(ServeTest, "serve/serial_client.py", serves_a_socket_as_it_does_a_serial_port)
SCRIPT_TEST(ServeTest, "serve/serial_client.py", works_through_a_socat_relay)
SCRIPT_TEST(ServeTest, "serve/serial_client.py", can_be_closed_and_opened_again)
SCRIPT_TEST(ServeTest, "serve/serial_client.py", serves_two_clients_one_after_the_other)
SCRIPT_TEST(ServeTest, "serve/serial_client.py", survives_a_flood_of_a_megabyte)
SCRIPT_TEST(ServeTest, "serve/serial_client.py", goes_on_when_the_client_stops_reading)
SCRIPT_TEST(ServeTest, "serve/serial_client.py", resynchronises_after_half_packets_garbage_and_reopening)
SCRIPT_TEST(ServeTest, "serve/serial_client.py", survives_an_unplug_in_the_middle_of_a_frame)
SCRIPT_TEST(ServeTest, "serve/serial_client.py", line_modes_of_one_client_do_not_reach_the_next)
SCRIPT_TEST(ServeTest, "serve/serial_client.py", counts_bad_packets_by_their_cause)
SCRIPT_TEST(ServeTest, "serve/serial_client.py", simulated_time_does_not_stall_while_a_client_floods)
SCRIPT_TEST(ServeTest, "serve/serial_client.py", paces_bytes_at_the_rate_that_is_asked_for)
SCRIPT_TEST(ServeTest, "serve/serial_client.py", ends_cleanly_on_every_stop_signal)
SCRIPT_TEST(ServeTest, "serve/serial_client.py", a_computer_that_cannot_keep_up_is_said)
SCRIPT_TEST(ServeTest, "serve/serial_client.py", the_status_line_fits_the_terminal)
SCRIPT_TEST(ServeTest, "serve/serial_client.py", refuses_a_name_that_a_file_has)
SCRIPT_TEST(ServeTest, "serve/serial_client.py", names_every_bad_argument)
SCRIPT_TEST(PhaseClientTest, "serve/phase_client.py", field_oriented_control_follows_a_velocity)
SCRIPT_TEST(PhaseClientTest, "serve/phase_client.py", six_step_control_follows_a_velocity)
SCRIPT_TEST(RemClientTest, "serve/rem_client.py", one_metre_per_second_forward)
SCRIPT_TEST(ExtcapTest, "serve/extcap_client.py", answers_what_wireshark_asks)
SCRIPT_TEST(ExtcapTest, "serve/extcap_client.py", tshark_shows_the_values_that_pass_a_running_bench)
SCRIPT_TEST(HostStreamTest, "serve/hermes_stream.py", real_host_drives_six_robots_with_no_frame_refused)
SCRIPT_TEST(MotorBusClientTest, "serve/motor_bus_client.py", bad_words_are_all_named)
SCRIPT_TEST(MotorBusClientTest, "serve/motor_bus_client.py",
            odrive_reaches_the_commanded_speed_and_stops_when_the_watchdog_expires)
SCRIPT_TEST(MotorBusClientTest, "serve/motor_bus_client.py", ateam_main_board_drives_four_uarts)
SCRIPT_TEST(MotorBusClientTest, "serve/motor_bus_client.py", ateam_main_board_at_four_serial_ports)

}  // namespace
}  // namespace omnihil
