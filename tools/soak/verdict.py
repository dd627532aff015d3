"""What a soak says: the account of packets at both ends, memory and descriptors over time. Pure: numbers in, sentences out.

    faults = packet_faults(7, robot, bench_good, bench_refused, bench_out)
    faults += flat_faults("robot 7", samples)
"""

# What may still be touched after the first quarter: the heap grows by 132 kB at a time, and twice is no leak (a leak of one byte
# a step is 600 kB in ten minutes).
FLAT_KB = 264


def packet_faults(number, robot, from_host, refused, from_robots):
    """`robot`: the host's account (rnp_host.Robot). The rest: the bench's."""
    faults = []

    def say(text):
        faults.append(f"robot {number}: {text}")

    if from_host != robot.sent:
        say(f"{robot.sent} packets sent to it, {from_host} arrived")
    if refused:
        say(f"{refused} packets refused")
    if from_robots != robot.received:
        say(f"{from_robots} packets sent by it, {robot.received} arrived")
    if robot.missing or robot.repeated or robot.damaged:
        say(f"telemetry: {robot.missing} numbers missing, {robot.repeated} repeated, {robot.damaged} damaged")
    return faults


def flat_faults(who, samples):
    """`samples`: (kB of memory, descriptors) at equal times. The first quarter is the start: flat is what comes after."""
    quarter = len(samples) // 4
    if quarter == 0:
        return [f"{who}: {len(samples)} samples of memory, at least 4 are needed"]
    kilobytes = [sample[0] for sample in samples[quarter:]]
    descriptors = [sample[1] for sample in samples[quarter:]]
    faults = []
    if max(kilobytes[-quarter:]) > kilobytes[0] + FLAT_KB:
        faults.append(f"{who}: memory grew from {kilobytes[0]} to {max(kilobytes[-quarter:])} kB")
    if max(descriptors) != min(descriptors):
        faults.append(f"{who}: from {descriptors[0]} to {descriptors[-1]} descriptors, at most {max(descriptors)}")
    return faults
