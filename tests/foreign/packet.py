"""Packet serial written a second time, from the manual's and the public clients' layouts, to judge the simulator from outside.

Nothing here is shared with the Rust codec. Layouts are `struct` formats, big-endian; generation 1 only.
"""

import os
import select
import struct
import termios
import time
import tty

from harness import PATIENCE_S, let_silence_be_noticed


def crc16(data, crc=0):
    """CRC-16/XMODEM: polynomial 0x1021, start 0, nothing reflected."""
    for byte in data:
        crc ^= byte << 8
        for _ in range(8):
            crc = (crc << 1 ^ 0x1021 if crc & 0x8000 else crc << 1) & 0xFFFF
    return crc


def sealed(data):
    """The bytes with their CRC behind them, high byte first."""
    return bytes(data) + struct.pack(">H", crc16(data))


SIGNAL_RECORD = "BBBBBIiiiiIiiiI"  # type, mode, target, two actions, timeout, home, min, max, center, deadband, exponent, outputs, power min
STREAM_RECORD = "BII"
SIGNAL_VALUES = "5i"

# Reads: number -> reply layout. Lists are a count byte and records.
READS = {
    16: "IB",
    17: "IB",
    18: "IB",
    19: "IB",
    24: "H",
    25: "H",
    30: "IB",
    31: "IB",
    47: "BB",
    48: "hh",
    49: "HH",
    55: "IIII",
    56: "IIII",
    59: "HH",
    60: "HH",
    63: "IIIIIii",
    64: "IIIIIii",
    78: "ii",
    79: "ii",
    81: "II",
    82: "h",
    83: "h",
    90: "H",
    91: "BB",
    130: "II",
    131: "II",
    135: "ii",
    136: "ii",
    140: "BBB",
    142: "B",
    149: "B",
    202: "B",
    247: "I",
}
LISTS = {138: "B", 144: SIGNAL_RECORD, 146: STREAM_RECORD, 147: SIGNAL_VALUES}

# Writes: number -> payload layout.
WRITES = {
    **{number: "B" for number in range(0, 14)},
    20: "",
    22: "I",
    23: "I",
    28: "IIII",
    29: "IIII",
    32: "h",
    33: "h",
    34: "hh",
    35: "i",
    36: "i",
    37: "ii",
    38: "Ii",
    39: "Ii",
    40: "Iii",
    41: "iIB",
    42: "iIB",
    43: "iIiIB",
    44: "IiIB",
    45: "IiIB",
    46: "IiIiIB",
    50: "IiIi",
    51: "IiIIiIB",
    52: "hI",
    53: "hI",
    54: "hIhI",
    57: "HH",
    58: "HH",
    61: "IIIIIii",
    62: "IIIIIii",
    65: "IIIiB",
    66: "IIIiB",
    67: "IIIiIIIiB",
    68: "I",
    69: "I",
    80: "",
    92: "B",
    93: "B",
    94: "I",
    95: "",
    128: "II",
    129: "II",
    133: "II",
    134: "II",
    137: "BB",
    139: "BBB",
    141: "BB",
    143: "B" + SIGNAL_RECORD,
    145: "B" + STREAM_RECORD,
    148: "B",
    200: "",
    201: "B",
    246: "I",
    248: "",
    249: "",
    253: "BH",
}


QUICK_S = 0.005  # bytes that follow each other within this are one packet


class Silence(Exception):
    """The controller did not answer in time."""


class BadReply(Exception):
    """The controller answered with something else than the layout says."""


class Port:
    """A raw file descriptor on a terminal, with the latency of each reply kept."""

    def __init__(self, path, limit_s=PATIENCE_S):
        self.descriptor = os.open(path, os.O_RDWR | os.O_NOCTTY)
        tty.setraw(self.descriptor, termios.TCSANOW)
        self.limit_s = limit_s
        self.latencies_ms = []
        self.gaps_ms = []

    def write(self, data):
        os.write(self.descriptor, data)

    def flush_input(self):
        termios.tcflush(self.descriptor, termios.TCIFLUSH)

    def read(self, count, limit_s=None):
        """Exactly `count` bytes; the wait for the first is a latency, each later wait a gap."""
        data = b""
        while len(data) < count:
            start = time.monotonic()
            ready, _, _ = select.select([self.descriptor], [], [], limit_s or self.limit_s)
            if not ready:
                raise Silence(f"{len(data)} of {count} bytes")
            waited_ms = (time.monotonic() - start) * 1000
            (self.gaps_ms if data else self.latencies_ms).append(waited_ms)
            data += os.read(self.descriptor, count - len(data))
        return data

    def is_silent(self, for_s=0.05):
        """Whether nothing arrives for that long."""
        ready, _, _ = select.select([self.descriptor], [], [], for_s)
        return not ready


class Client:
    """The plain style: one write per packet, strict acknowledgement."""

    def __init__(self, port, address=0x80):
        self.port = port
        self.address = address

    def send(self, data):
        self.port.flush_input()
        self.port.write(data)

    def write(self, number, *values):
        """Sends a write command and demands the byte 0xFF."""
        payload = struct.pack(">" + WRITES[number], *values)
        self.send(sealed(bytes([self.address, number]) + payload))
        self.expect_ack()

    def expect_ack(self):
        answer = self.port.read(1)
        if answer != b"\xff":
            raise BadReply(f"0x{answer[0]:02x} instead of 0xFF")

    def request(self, number, arguments=b""):
        self.send(bytes([self.address, number]) + arguments)

    def read(self, number, arguments=b"", layout=None):
        """Sends a read command and returns the values of its fixed layout."""
        layout = ">" + (layout or READS[number])
        self.request(number, arguments)
        return struct.unpack(layout, self.checked(number, arguments, struct.calcsize(layout)))

    def read_list(self, number):
        """Sends a read command whose reply is a count and records."""
        layout = ">" + LISTS[number]
        self.request(number)
        count = self.port.read(1)
        body = self.port.read(count[0] * struct.calcsize(layout) + 2)
        self.check(bytes([self.address, number]) + count + body)
        size = struct.calcsize(layout)
        return [struct.unpack_from(layout, body, index * size) for index in range(count[0])]

    def read_version(self):
        self.request(21)
        text = b""
        while not text.endswith(b"\0"):
            text += self.port.read(1)
            if len(text) > 48:
                raise BadReply("the version has no end")
        self.check(bytes([self.address, 21]) + text + self.port.read(2))
        return text[:-1].decode("ascii")

    def checked(self, number, arguments, size):
        data = self.port.read(size + 2)
        self.check(bytes([self.address, number]) + arguments + data)
        return data[:size]

    @staticmethod
    def check(data):
        if crc16(data) != 0:  # data followed by its own CRC always gives 0
            raise BadReply(f"bad CRC in {data.hex()}")


class BytewiseClient(Client):
    """The style of the microcontroller libraries: every byte a write of its own."""

    def send(self, data):
        while True:
            self.port.flush_input()
            longest_gap_s, written_at = 0.0, time.monotonic()
            for byte in data:
                self.port.write(bytes([byte]))
                longest_gap_s = max(longest_gap_s, time.monotonic() - written_at)
                written_at = time.monotonic()
            if longest_gap_s < QUICK_S:
                return
            # A busy machine has torn the packet apart, which is then none: once more, as its library does.
            let_silence_be_noticed()


class AppendingClient(Client):
    """The style of several third-party clients: read requests carry a CRC that the manual does not ask for."""

    def request(self, number, arguments=b""):
        self.send(sealed(bytes([self.address, number]) + arguments))
