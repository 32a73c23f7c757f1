"""Reads and writes whose widths changed between firmware generations, from outside.

Usage: generations_check.py PORT GENERATION. The widths are those of the manual and of public clients of 2015 to 2025; a reply
that is a byte too long or too short has a bad CRC or leaves a byte behind, and is found either way.
"""

import struct
import sys

import harness
from harness import truth
from packet import BadReply, Client, Port, Silence, sealed

KEY = 0xE22EAB7A

# Read -> layouts of generations 1 to 4; None where the generation does not have the command.
READS = {
    59: ("HH", "HH", "HH", "HHB"),
    75: ("BBB", "BBB", "BBB", "BBBBB"),
    77: ("BB", "BB", "BBBB", "BBHHHHHBBHHHHH"),
    81: ("II", "IIII", "IIII", "IIII"),
    90: ("H", "H", "I", "I"),
    97: (None, None, "37s", "37s"),
    100: (None, None, None, "HH"),
    103: (None, None, None, "BB"),
    104: (None, None, None, "HHHHH"),
    107: (None, "HIHI", "HIHI", "II"),
    110: (None, None, "II", "HH"),
    111: (None, None, "ii", "HH"),
    113: (None, None, "II", "HH"),
    114: (None, None, "ii", "HH"),
    142: ("B", "BB", "BB", "BB"),
    149: ("B", "B", "BB", "BB"),
}
SIGNAL_RECORD_BYTES = (45, 48, 52, 52)

# Write -> payload lengths that some generation sends. Real units are met by clients of every age: each length is taken.
WRITES = {57: (4, 5), 68: (4, 8), 69: (4, 8), 74: (3, 5), 76: (2, 4, 24), 94: (0, 4), 143: (46, 49, 53), 148: (1, 2)}
LATER_WRITES = {105: (4, 6), 106: (4, 6), 109: (4, 8), 112: (4, 8)}  # only where the generation has the command
FIRST_GENERATION = {105: 2, 106: 2, 109: 3, 112: 3}


def main():
    client = Client(Port(sys.argv[1]))
    generation = int(sys.argv[2])
    for number, layouts in READS.items():
        if layouts[generation - 1]:
            check(f"read {number}", lambda: check_read(client, number, layouts[generation - 1]))
    check("read 144", lambda: check_signals(client, SIGNAL_RECORD_BYTES[generation - 1]))
    writes = dict(WRITES)
    writes |= {n: lengths for n, lengths in LATER_WRITES.items() if generation >= FIRST_GENERATION[n]}
    for number, lengths in writes.items():
        for length in lengths:
            check(f"write {number} with {length} bytes", lambda: check_write(client, number, length))
    check("restore defaults without a key", lambda: acknowledged(client, bytes([0x80, 80])))
    check("restore defaults with the key", lambda: acknowledged(client, bytes([0x80, 80]) + struct.pack(">I", KEY)))
    check("version", lambda: harness.report("version", client.read_version() == truth()["version"] + "\n"))
    harness.finish()


def check(name, part):
    try:
        part()
    except (Silence, BadReply) as error:
        harness.report(name, False, f"{type(error).__name__}: {error}")


def check_read(client, number, layout):
    client.read(number, layout=layout)
    harness.report(f"read {number}", client.port.is_silent(0.004), "more bytes than its layout")


def check_signals(client, record_bytes):
    client.request(144)
    count = client.port.read(1)
    client.check(bytes([client.address, 144]) + count + client.port.read(count[0] * record_bytes + 2))
    harness.report("read 144", client.port.is_silent(0.004), "more bytes than its records")


def check_write(client, number, length):
    payload = struct.pack(">I", KEY) if number == 94 else bytes(length)
    acknowledged(client, bytes([client.address, number]) + payload[:length])
    harness.report(f"write {number} with {length} bytes", client.port.is_silent(0.02), "more than one byte")


def acknowledged(client, data):
    client.send(sealed(data))
    client.expect_ack()


if __name__ == "__main__":
    main()
