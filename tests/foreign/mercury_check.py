"""The simulated SuprMotr, driven by the Python package `basil_daq`, which knows a sister controller (PI C-863 "Mercury").

Usage: mercury_check.py PORT. PORT is a path or a URL of pySerial. The boards on the line have the addresses 0 and 3, say only the letter in front of their
reports, and have their echo off.
"""

import sys
import time
import types


def stand_in(name, **parts):
    """The package imports these for other instruments; the driver of this one uses none of them."""
    module = types.ModuleType(name)
    for part, value in parts.items():
        setattr(module, part, value)
    sys.modules[name] = module


stand_in("git")
stand_in("numpy")
stand_in("bitarray", bitarray=object)

import serial  # noqa: E402
from basil.HL import mercury  # noqa: E402
from basil.HL.mercury import Mercury  # noqa: E402
from basil.TL.Serial import Serial  # noqa: E402

import harness  # noqa: E402

PORT = sys.argv[1]
# For so long nothing comes from an address that no board has. Over TCP a board answers within a few milliseconds, however busy the computer is.
SILENCE_S = 0.3
# A shaft that has stood for so long of the board's time has come to its rest.
REST_S = 0.15


def machine():
    """The time of the boards, and where their encoders are, past the wire."""
    boards = harness.truth()
    now = boards[0]["now"]
    return now["secs"] + now["nanos"] / 1e9, [board["axes"][0]["encoder_counts"] for board in boards]


def pause(seconds):
    """The driver's pause between two looks at a position: as long as it wants to while a shaft turns, so that one which creeps is seen, and
    no longer where all have come to their rest, since they would stand at the second look, too."""
    end = time.monotonic() + seconds
    stands_since, stands_at = machine()
    while time.monotonic() < end:
        now, at = machine()
        if at != stands_at:
            stands_since, stands_at = now, at
        elif now >= stands_since + REST_S:
            return
        time.sleep(0.005)


# Any port that pySerial knows, not only a file.
serial.Serial = lambda port, **options: serial.serial_for_url(port, **options)
mercury.time = types.SimpleNamespace(sleep=pause)
# What friction leaves of a move at factory gains.
NEAR = 30


def check(name, passed, detail=""):
    harness.report(name, passed, detail)


def position(unit):
    """Where the encoder of a board is, past the wire."""
    return harness.truth()[unit]["axes"][0]["encoder_counts"]


# As the package's own example has it: the write termination is that of reading then, so that an end of text follows every line.
line = Serial({"name": "line", "init": {"port": PORT, "baudrate": 9600, "timeout": SILENCE_S, "read_termination": "\x03"}})
line.init()
stage = Mercury(line, {"name": "stage", "init": {}})
stage.init()
# It asks each address twice and reads one answer: the second one is taken for the next address's.
check("init", stage._board_numbers == [0, 1, 3, 4], stage._board_numbers)
# From here on only what answers is asked.
line._port.timeout = harness.PATIENCE_S

for board, unit in [(0, 0), (3, 1)]:
    name = f"board {board}: "
    check(name + "get_board_number", stage.get_board_number(board) == f"B:+{board:010}\r\n\x03")
    stage.motor_on(board)
    stage.LL(board)
    stage.set_position(3000, board_number=board, wait=True)
    got = stage.get_position(board)
    check(name + "set_position", abs(got - 3000) <= NEAR, got)
    check(name + "get_position", got == position(unit), (got, position(unit)))
    stage.move_relative(-1000, board_number=board, wait=True)
    got = stage.get_position(board)
    check(name + "move_relative", abs(got - 2000) <= 2 * NEAR, got)
    stage.set_home(board)
    check(name + "set_home", stage.get_position(board) == 0)
    stage.set_position(1500, board_number=board, wait=True)
    stage.go_home(board)
    got = stage._wait(board)
    check(name + "go_home", abs(got) <= NEAR, got)
    status = stage.get_channel(board)
    # Selected and leading zeros kept, no echo; complete; limits on.
    check(name + "get_channel", status.startswith("S:A0 ") and status.endswith(" 01 04 00 00\r\n\x03"), repr(status))
    stage.set_position(20000, board_number=board)
    check(name + "moves", harness.eventually(lambda: position(unit) > 6000))
    stage.abort(board)
    at = stage._wait(board)
    check(name + "abort", at < 15000, at)
    stage.motor_off(board)
    status = stage.get_channel(board).split(" ")
    check(name + "motor_off", int(status[1], 16) & 1 == 1, status)
    stage.motor_on(board)

# To the negative limit, 60,000 counts from where the board was switched on, and off it again as the manual homes.
stage.find_edge(1, 0)
edge = position(0)
check("find_edge 1", abs(edge + 60000) <= 400, edge)
stage._write_command("DV500", 0)
stage.find_edge(4, 0)
edge = position(0)
check("find_edge 4", abs(edge + 59999) <= 25, edge)
stage.set_home(0)

# Without a board number it goes to all that it found.
stage._write_command("DV20000")
stage.set_position(1000)
done = harness.eventually(lambda: abs(stage.get_position(0) - 1000) <= NEAR and abs(stage.get_position(3) - 1000) <= NEAR)
check("all boards", done, (stage.get_position(0), stage.get_position(3)))

harness.finish()
