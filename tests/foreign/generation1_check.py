"""Drives the simulator in generation 1 in three styles of public clients, with strict 0xFF acknowledgements.

The layouts are those of packet.py, written from the manual and not from the Rust codec. Each finding is compared with the
simulator's own memory. The time to the first byte of each reply is measured against the 5 ms that strict clients allow.
"""

import os
import random
import sys
import time

import harness
from harness import let_silence_be_noticed, truth, wait_until
from packet import AppendingClient, BadReply, BytewiseClient, Client, LISTS, Port, READS, Silence, sealed

REPLY_LIMIT_MS = 5.0


class Findings:
    """Names what is being checked, and reports each finding once."""

    def __init__(self, style):
        self.style = style

    def check(self, name, passed, detail=""):
        harness.report(f"{self.style}: {name}", passed, "" if passed else detail)

    def equal(self, name, found, wanted):
        self.check(name, found == wanted, f"found {found!r}, the truth is {wanted!r}")


def main():
    port = Port(sys.argv[1])
    for client in (Client(port), BytewiseClient(port), AppendingClient(port)):
        findings = Findings(type(client).__name__)
        for part in (every_read, settings, lists, memory, motion):
            attempt(findings, part, client)
    findings = Findings("wire")
    for part in (silence, gaps, stub_frames, garbage):
        attempt(findings, part, Client(port))
    latency(port)
    harness.finish()


def attempt(findings, part, client):
    """A reply that does not come ends one part, not the whole run."""
    try:
        part(findings, client)
    except (Silence, BadReply) as error:
        findings.check(part.__name__, False, f"broke off: {type(error).__name__}: {error}")


def every_read(findings, client):
    """Each read of the manual answers with exactly its layout, and with nothing after it."""
    for number in READS:
        client.read(number)
        findings.check(f"read {number}", client.port.is_silent(0.004), "more bytes than its layout")
    for number in LISTS:
        client.read_list(number)
        findings.check(f"read {number}", client.port.is_silent(0.004), "more bytes than its layout")
    findings.equal("read 21", client.read_version(), truth()["version"] + "\n")


# Write, values, read, the values that the read must return.
GAINS = (0x4000, 0x18000, 0x8000, 30000)  # D, P, I, QPPS
POSITION = (512, 4096, 256, 50, 4, -20000, 30000)  # D, P, I, MaxI, dead zone, min, max
PAIRS = [
    (28, GAINS, 55, (0x18000, 0x8000, 0x4000, 30000)),
    (29, GAINS, 56, (0x18000, 0x8000, 0x4000, 30000)),
    (61, tuple(v & 0xFFFFFFFF for v in POSITION[:5]) + POSITION[5:], 63, (4096, 256, 512, 50, 4, -20000, 30000)),
    (62, POSITION, 64, (4096, 256, 512, 50, 4, -20000, 30000)),
    (57, (70, 300), 59, (70, 300)),
    (58, (60, 280), 60, (60, 280)),
    (128, (16777, 8388608), 130, (16777, 8388608)),
    (128, (0, 0), 130, (0, 0)),
    (129, (16778, 8388609), 131, (16778, 8388609)),
    (129, (0, 0), 131, (0, 0)),
    (133, (2500, 0), 135, (2500, 0)),
    (134, (2600, 0), 136, (2600, 0)),
    (139, (1, 3, 2), 140, (1, 3, 2)),
    (139, (1, 0, 0), 140, (1, 0, 0)),
    (141, (0x80, 1), 142, (1,)),
    (141, (0x80, 0), 142, (0,)),
    (246, (3000,), 247, (3000,)),
    (246, (0,), 247, (0,)),
]


def settings(findings, client):
    for number, values, reader, wanted in PAIRS:
        client.write(number, *values)
        findings.equal(f"write {number} {values}, read {reader}", client.read(reader), wanted)
    encoder_modes = client.read(91)
    findings.equal("encoder modes", encoder_modes, tuple(m["encoder_mode"] for m in truth()["settings"]["motors"]))
    client.write(92, 1)
    client.write(93, 2)
    findings.equal("encoder modes written", client.read(91), (1, 2))
    client.write(92, encoder_modes[0])
    client.write(93, encoder_modes[1])
    client.write(68, 222222)
    client.write(69, 333333)
    findings.equal("default accelerations", client.read(81), (222222, 333333))
    in_memory = [m["default_accel_raw"] for m in truth()["settings"]["motors"]]
    findings.equal("default accelerations in memory", in_memory, [222222, 333333])
    gains = [m["velocity_p_raw"] for m in truth()["settings"]["motors"]]
    findings.equal("velocity P in memory", gains, [0x18000, 0x18000])
    limits = [truth()["settings"][key] for key in ("main_min_tenths", "main_max_tenths")]
    findings.equal("main battery limits in memory", limits, [70, 300])


def lists(findings, client):
    findings.equal("signals counted", len(client.read_list(144)), len(truth()["settings"]["signals"]))
    findings.equal("signal values counted", len(client.read_list(147)), len(truth()["settings"]["signals"]))
    record = (1, 0, 0, 0, 0, 800, -5, 10, 4000, 2000, 30, 65536, -30000, 31000, 7)
    client.write(143, 2, *record)
    findings.equal("signal 2 read back", client.read_list(144)[2], record)
    findings.equal("signal 2 in memory", truth()["settings"]["signals"][2]["center"], 2000)
    client.write(145, 3, 1, 57600, 400)
    findings.equal("stream 3 read back", client.read_list(146)[3], (1, 57600, 400))
    client.write(137, 0, 2)
    findings.equal("DOUT 0 read back", client.read_list(138)[0], (2,))
    findings.equal("DOUT 0 in memory", truth()["settings"]["outputs"][0], 2)
    client.write(137, 0, 0)


def memory(findings, client):
    client.write(253, 9, 0x1234)
    findings.equal("user memory", client.read(252, bytes([9]), "H"), (0x1234,))
    findings.equal("user memory in memory", truth()["user_memory"][9], 0x1234)
    client.write(94, 0xE22EAB7A)
    saved = wait_until(lambda t: t["saved_settings"] == t["settings"])
    findings.check("94 saves", saved, "the EEPROM does not hold what RAM holds")


def duty_of(index):
    return truth()["motors"][index]["duty_raw"]


# Command, values, motor that must move, its direction.
MOTIONS = [
    (0, (64,), 0, 1),
    (1, (64,), 0, -1),
    (4, (64,), 1, 1),
    (5, (64,), 1, -1),
    (6, (96,), 0, 1),
    (6, (32,), 0, -1),
    (7, (96,), 1, 1),
    (32, (9000,), 0, 1),
    (33, (-9000,), 1, -1),
    (34, (-9000, 9000), 0, -1),
    (35, (3000,), 0, 1),
    (36, (-3000,), 1, -1),
    (37, (-3000, 3000), 0, -1),
    (38, (60000, 3000), 0, 1),
    (39, (60000, -3000), 1, -1),
    (40, (60000, 3000, 3000), 0, 1),
    (41, (3000, 60000, 1), 0, 1),
    (42, (-3000, 60000, 1), 1, -1),
    (43, (3000, 60000, -3000, 60000, 1), 1, -1),
    (44, (60000, 3000, 60000, 1), 0, 1),
    (45, (60000, -3000, 60000, 1), 1, -1),
    (46, (60000, 3000, 60000, -3000, 60000, 1), 0, 1),
    (50, (60000, 3000, 50000, -3000), 1, -1),
    (51, (60000, 3000, 60000, 50000, -3000, 60000, 1), 0, 1),
    (52, (9000, 200000), 0, 1),
    (53, (-9000, 200000), 1, -1),
    (54, (9000, 200000, -9000, 200000), 1, -1),
    (65, (60000, 3000, 60000, 10000, 1), 0, 1),
    (66, (60000, 3000, 60000, -10000, 1), 1, -1),
    (67, (60000, 3000, 60000, -9000, 60000, 3000, 60000, 9000, 1), 0, -1),
]


def motion(findings, client):
    for number, values, index, direction in MOTIONS:
        turns = lambda t: t["motors"][index]["speed_counts_per_s"] * direction > 100
        turned = harness.reached(lambda: client.write(number, *values) or True, turns, lambda: client.read(49))
        findings.check(f"motion {number} {values}", turned, f"{truth()['motors']}")
        client.write(34, 0, 0)
        wait_until(lambda t: all(abs(m["speed_counts_per_s"]) < 20 for m in t["motors"]))
        client.write(20)
    # Mixed commands need a drive and a turn value, once each, before anything moves.
    mixed = lambda: (client.write(8, 64), client.write(10, 0))
    both_turn = lambda t: duty_of(0) > 8000 and duty_of(1) > 8000
    turned = harness.reached(mixed, both_turn, lambda: client.read(49))
    findings.check("motion 8 with 10", turned, f"{truth()['motors']}")
    client.write(12, 64)
    client.write(13, 64)
    findings.check("12 and 13 at 64 stop", wait_until(lambda t: duty_of(0) == duty_of(1) == 0), f"{truth()['motors']}")
    client.write(34, 0, 0)


def silence(findings, client):
    """Nothing answers a bad CRC, an unknown command or a packet that is cut off."""
    packet = sealed(bytes([0x80, 32, 0x10, 0x00]))
    for name, data in (
        ("bad CRC", packet[:-1] + bytes([packet[-1] ^ 1])),
        ("unknown command", sealed(bytes([0x80, 199, 1, 2]))),
        ("cut off", packet[:4]),
    ):
        client.send(data)
        findings.check(f"{name}: silence", client.port.is_silent(), f"answered {data.hex()}")
        findings.equal(f"{name}: no motion", duty_of(0), 0)
        let_silence_be_noticed()
        findings.check(f"{name}: the next packet is understood", len(client.read(24)) == 1)


def gaps(findings, client):
    """More than 10 ms between two bytes discards the packet; a packet in quick pieces is one packet."""
    packet = sealed(bytes([0x80, 32, 0x10, 0x00]))
    client.send(packet[:3])
    let_silence_be_noticed()
    client.port.write(packet[3:])
    findings.check("a gap discards", client.port.is_silent(), "answered")
    findings.equal("a gap discards: no motion", duty_of(0), 0)
    let_silence_be_noticed()
    client.write(32, 0)
    findings.check("after a gap the next packet is understood", True)


def stub_frames(findings, client):
    """Address and command with nothing after them, as one library leaves them on the line, are forgotten in 10 ms."""
    for _ in range(3):
        client.send(bytes([0x80, 52]))
        let_silence_be_noticed()
        client.write(20)
    findings.check("stub frames are forgotten", True)


def garbage(findings, client):
    random.seed(4)
    for _ in range(20):
        client.send(bytes(random.getrandbits(8) for _ in range(random.randrange(1, 60))))
        let_silence_be_noticed()
    client.port.flush_input()
    client.write(34, 0, 0)
    client.write(200)
    findings.check("answers after random bytes", len(client.read(25)) == 1)


def latency(port):
    """Figures for the record. What they may be is judged by `brushwork bench link`, on a machine that has a core to spare."""
    ordered = sorted(port.latencies_ms)
    median = ordered[len(ordered) // 2]
    late_share = sum(value > REPLY_LIMIT_MS for value in ordered) / len(ordered)
    load_per_core = os.getloadavg()[0] / (os.cpu_count() or 1)
    harness.figure("replies measured", len(ordered), "replies")
    harness.figure("median time to reply", median, "ms")
    harness.figure("99th percentile of time to reply", ordered[len(ordered) * 99 // 100], "ms")
    harness.figure("longest gap inside a reply", max(port.gaps_ms, default=0.0), "ms")
    harness.figure("replies after more than 5 ms", late_share * 100, "%")
    harness.figure("load of the machine per core", load_per_core, "")


if __name__ == "__main__":
    main()
