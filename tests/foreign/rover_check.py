"""Five controllers of a rover on one line, driven by `basicmicro.Basicmicro` 2.0.10: each does what it was told, and no other.

Usage: rover_check.py PORT FIRST COUNT. Everything is asked over the wire, so that any controllers on any line will do.
"""

import math
import sys
import time

from basicmicro import Basicmicro

import harness

FULL_DUTY = 32767
RETRIES = 20  # the library sends a packet in pieces: on a busy machine the 10 ms gap may fall between two of them


def tried(act):
    """The first success of several tries, or the last failure."""
    for _ in range(RETRIES):
        answer = act()
        if answer if isinstance(answer, bool) else answer[0]:
            return answer
        time.sleep(0.02)
    return answer


def given(device, addresses, holds):
    """The duties of all, once they are as they should be or have had time to be: a controller ramps what it is told."""
    deadline = time.monotonic() + harness.PATIENCE_S
    while True:
        read = [tried(lambda: device.ReadPWMs(address)) for address in addresses]
        answers = [(one, other) if answered else (math.nan, math.nan) for answered, one, other in read]
        if holds(answers) or time.monotonic() > deadline:
            return answers
        time.sleep(0.02)


def main():
    device = Basicmicro(sys.argv[1], 115200, timeout=1)
    first, count = int(sys.argv[2], 0), int(sys.argv[3])
    device.Open()
    addresses = list(range(first, first + count))

    versions = [tried(lambda: device.ReadVersion(address)) for address in addresses]
    harness.report("each answers", all(version[0] for version in versions), versions)
    silent, _ = device.ReadVersion(addresses[-1] + 1)
    harness.report("nobody answers for an address that nobody has", not silent, silent)

    wanted = [(place + 1) * FULL_DUTY // (2 * count) for place in range(count)]
    for address, duty in zip(addresses, wanted):
        tried(lambda: device.DutyM1M2(address, duty, -duty))
    own = [(duty, -duty) for duty in wanted]

    def are(expected):
        return lambda answers: all(
            abs(here - there) <= 2 for answer, pair in zip(answers, expected) for here, there in zip(answer, pair)
        )

    answers = given(device, addresses, are(own))
    harness.report("each has its own duty", are(own)(answers), [answers, own])

    time.sleep(0.5)
    speeds = [tried(lambda: device.ReadSpeedM1(address)) for address in addresses]
    rising = all(here[1] < there[1] for here, there in zip(speeds, speeds[1:]))
    harness.report("each turns at its own speed", rising and speeds[0][1] > 0, speeds)

    middle = addresses[count // 2]
    tried(lambda: device.DutyM1M2(middle, 0, 0))
    but_one = [(0, 0) if address == middle else pair for address, pair in zip(addresses, own)]
    answers = given(device, addresses, are(but_one))
    harness.report("one stop stands one", are(but_one)(answers), answers)

    limits = [1000 + 100 * place for place in range(count)]
    for address, limit in zip(addresses, limits):
        tried(lambda: device.SetM1MaxCurrent(address, limit, 0))
    held = [tried(lambda: device.ReadM1MaxCurrent(address)) for address in addresses]
    harness.report("each keeps its own limit", [answer[1] for answer in held] == limits, [held, limits])

    for address in addresses:
        tried(lambda: device.DutyM1M2(address, 0, 0))
    standing = [(0, 0)] * count
    answers = given(device, addresses, are(standing))
    harness.report("all stand in the end", are(standing)(answers), answers)
    harness.finish()


if __name__ == "__main__":
    main()
