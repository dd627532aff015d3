"""What tools/soak says of made-up accounts: each fault is named, a sound account has none. And its host's packets:
their sizes and sums."""
import os
import struct
import sys
import unittest
import zlib

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../tools/soak"))
import rnp_host  # noqa: E402
from stall_watch import StallWatch  # noqa: E402
from verdict import FLAT_KB, flat_faults, packet_faults  # noqa: E402


def robot(sent=61, telemetry=100, hellos=1):
    made = rnp_host.Robot(7, None)
    made.socket.close()
    made.sent, made.hellos = sent, hellos
    for number in range(telemetry):
        made.telemetry += 1
        made.number_came(number)
    return made


class Packets(unittest.TestCase):
    def test_a_sound_account_has_no_fault(self):
        self.assertEqual(packet_faults(7, robot(), 61, 0, 101), [])

    def test_a_command_that_did_not_arrive_is_named(self):
        self.assertEqual(packet_faults(7, robot(), 60, 0, 101), ["robot 7: 61 packets sent to it, 60 arrived"])

    def test_an_answer_that_did_not_arrive_is_named(self):
        self.assertEqual(packet_faults(7, robot(), 61, 0, 102), ["robot 7: 102 packets sent by it, 101 arrived"])

    def test_a_refused_packet_is_named(self):
        self.assertEqual(packet_faults(7, robot(), 61, 1, 101), ["robot 7: 1 packets refused"])

    def test_a_gap_in_the_numbers_is_missing_and_an_old_number_repeated(self):
        gone = robot(telemetry=0)
        for number in (0, 1, 4, 5, 5, 6):
            gone.number_came(number)
        self.assertEqual((gone.missing, gone.repeated, gone.next_number), (2, 1, 7))

    def test_numbers_go_on_at_zero_after_65535(self):
        around = robot(telemetry=0)
        around.next_number = 65535
        for number in (65535, 0, 1):
            around.number_came(number)
        self.assertEqual((around.missing, around.repeated), (0, 0))


class Flat(unittest.TestCase):
    def test_a_start_that_grows_and_then_stays_is_flat(self):
        self.assertEqual(flat_faults("it", [(100, 3), (5000, 4), (9000, 4)] + 9 * [(9000, 4)]), [])

    def test_a_leak_is_named(self):
        samples = [(9000 + 20 * FLAT_KB * n // 39, 4) for n in range(40)]
        self.assertEqual(len(flat_faults("it", samples)), 1)

    def test_a_descriptor_more_is_named(self):
        self.assertEqual(flat_faults("it", 20 * [(9000, 4)] + 20 * [(9000, 5)]), ["it: from 4 to 5 descriptors, at most 5"])

    def test_too_few_samples_are_no_verdict(self):
        self.assertEqual(len(flat_faults("it", 3 * [(9000, 4)])), 1)


class Stalls(unittest.TestCase):
    def test_the_watch_ends_with_what_it_saw(self):
        watch = StallWatch(min(os.sched_getaffinity(0)))
        self.assertTrue(watch.refused or all(stall > 0.01 for stall in watch.stalls_s()))


class Bytes(unittest.TestCase):
    def test_the_sum_is_of_what_follows_it(self):
        made = rnp_host.packet(rnp_host.CONTROL, bytes(24))
        self.assertEqual((len(made), made[4:12]), (36, bytes([0, 0, 1, 0, 0xC9, 0, 24, 0])))
        self.assertEqual(struct.unpack("<I", made[:4])[0], zlib.crc32(made[4:]))

    def test_two_packets_in_one_datagram_are_two_and_a_cut_one_is_none(self):
        one = rnp_host.packet(rnp_host.TELEMETRY, bytes(40))
        self.assertEqual([kind for kind, _ in rnp_host.packets_in(one + one)], [rnp_host.TELEMETRY] * 2)
        self.assertEqual([kind for kind, _ in rnp_host.packets_in(one + one[:-1])], [rnp_host.TELEMETRY, None])


if __name__ == "__main__":
    unittest.main()
