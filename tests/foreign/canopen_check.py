"""The CANopen node of the simulated controller, judged by the Python package `canopen`.

Usage: canopen_check.py PORT NODE EDS. EDS is the node's data sheet, by whose names objects are read. PORT is a GridConnect adapter in its ASCII form, for which python-can has no interface; the one here
shares nothing with the project but the public description of `:S601N40181001;`.
"""

import sys
import time

import can
import canopen
import serial

import harness

PORT, NODE, EDS = sys.argv[1], int(sys.argv[2]), sys.argv[3]


class GridConnect(can.BusABC):
    """Frames as text on a serial port."""

    def __init__(self, port):
        self.port = serial.Serial(port, 115200, timeout=0)
        self.text = b""
        self.channel_info = "GridConnect on " + port
        self._can_protocol = can.CanProtocol.CAN_20
        super().__init__(channel=port)

    def send(self, msg, timeout=None):
        head = ":X%08X" % msg.arbitration_id if msg.is_extended_id else ":S%03X" % msg.arbitration_id
        body = "R%d" % msg.dlc if msg.is_remote_frame else "N" + bytes(msg.data).hex().upper()
        self.port.write((head + body + ";").encode())

    def _recv_internal(self, timeout):
        deadline = None if timeout is None else time.monotonic() + timeout
        while b";" not in self.text:
            self.text += self.port.read(256)
            if b";" in self.text:
                break
            if deadline is not None and time.monotonic() >= deadline:
                return None, False
            time.sleep(0.001)
        frame, _, self.text = self.text.partition(b";")
        return self.parse(frame.decode()), False

    @staticmethod
    def parse(text):
        kind, rest = text.lstrip("\r\n")[1], text.lstrip("\r\n")[2:]
        at = next(index for index, letter in enumerate(rest) if letter in "NR")
        data = bytes.fromhex(rest[at + 1 :]) if rest[at] == "N" else b""
        return can.Message(
            timestamp=time.time(),
            arbitration_id=int(rest[:at], 16),
            is_extended_id=kind == "X",
            is_remote_frame=rest[at] == "R",
            data=data,
        )

    def shutdown(self):
        super().shutdown()
        self.port.close()


def check(name, found, expected):
    harness.report(name, found == expected, f"{found!r} instead of {expected!r}")


def number(data, signed=False):
    return int.from_bytes(data, "little", signed=signed)


def abort_code(access):
    try:
        access()
    except canopen.SdoAbortedError as error:
        return error.code
    return None


network = canopen.Network(bus=GridConnect(PORT))
network.connect()
truth = harness.truth()

network.scanner.search()
harness.eventually(lambda: NODE in network.scanner.nodes)
check("the scanner finds the node", sorted(set(network.scanner.nodes)), [NODE])

node = canopen.RemoteNode(NODE, canopen.ObjectDictionary())
network.add_node(node)
sdo = node.sdo
sdo.RESPONSE_TIMEOUT = harness.PATIENCE_S

check("device type", number(sdo.upload(0x1000, 0)), 0)
check("error register", number(sdo.upload(0x1001, 0)), 0)
check("device name, in segments", sdo.upload(0x1008, 0).decode(), truth["version"].rsplit(" ", 1)[0])
check("identity has four parts", number(sdo.upload(0x1018, 0)), 4)
check("product", number(sdo.upload(0x1018, 2)), 266)
check("version as a command object", sdo.upload(0x2015, 1).decode().strip(), truth["version"])
battery = number(sdo.upload(0x2018, 0))
harness.report("main battery", abs(battery - truth["main_tenths"]) <= 1, f"{battery} against {truth['main_tenths']}")
check("status", number(sdo.upload(0x205A, 0)), truth["status_word"])
check("streams are a list of five", number(sdo.upload(0x2092, 1)), 5)

# By the names of the data sheet, with types, signs and limits as it has them.
named = canopen.RemoteNode(NODE, EDS)
network.add_node(named)
by_name = named.sdo
by_name.RESPONSE_TIMEOUT = harness.PATIENCE_S
check("the sheet is of this product", named.object_dictionary.device_information.product_number, 266)
check("battery by name", by_name["Read main battery"].raw, number(by_name.upload(0x2018, 0)))
check("version by name", by_name["Read version"]["Text"].raw.strip("\n\0 "), truth["version"])
check("identity by name", by_name["Identity object"]["Product code"].raw, 266)
written = by_name["M1 velocity PID"]
for part, value in (("D", 0x4000), ("P", 0x10000), ("I", 0x8000), ("Qpps", 12345)):
    written[part].raw = value
check("a gain written by name is read by name", by_name["Read M1 velocity PID"]["Qpps"].raw, 12345)
limits = by_name["M1 duty"].od
check("limits of a duty", (limits.min, limits.max), (-32767, 32767))
checked, refused = 0, []
for entry in named.object_dictionary.values():
    parts = [entry] if isinstance(entry, canopen.objectdictionary.ODVariable) else list(entry.values())
    for part in parts:
        if part.access_type in ("ro", "rw", "const"):
            checked += 1
            try:
                by_name.upload(part.index, part.subindex)
            except canopen.SdoAbortedError as error:
                refused.append("%04X:%d %s" % (part.index, part.subindex, error))
harness.report("every readable object of the sheet is there", not refused, refused)
harness.report("and they are many", checked > 150, checked)
network.add_node(node)

check("no such object", abort_code(lambda: sdo.upload(0x1234, 0)), 0x06020000)
check("no such part", abort_code(lambda: sdo.upload(0x1018, 9)), 0x06090011)
check("read only", abort_code(lambda: sdo.download(0x2018, 0, b"\0\0")), 0x06010002)
check("write only", abort_code(lambda: sdo.upload(0x2020, 0)), 0x06010001)
check("segments that are too long", abort_code(lambda: sdo.download(0x2020, 0, b"0123456789")), 0x06070010)
check(
    "block transfer is refused",
    abort_code(lambda: sdo.open(0x1008, 0, "rb", block_transfer=True).read()),
    0x05040001,
)

sdo.download(0x1017, 0, (200).to_bytes(2, "little"))
check("the heartbeat comes as often as it is told", node.nmt.wait_for_heartbeat(timeout=harness.PATIENCE_S), "PRE-OPERATIONAL")
states = []
node.nmt.add_heartbeat_callback(states.append)
node.nmt.state = "OPERATIONAL"
check("operational", harness.eventually(lambda: 5 in states), True)

sdo.download(0x2020, 0, (0x2000).to_bytes(2, "little"))
harness.report(
    "duty drives motor 1",
    harness.wait_until(lambda truth: abs(truth["motors"][0]["duty_raw"] - 0x2000) < 40),
    harness.truth()["motors"][0],
)
sdo.download(0x1016, 1, (0x007E0064).to_bytes(4, "little"))
network.send_message(0x77E, [5])
lost = harness.eventually(lambda: any(entry.code == 0x8130 for entry in node.emcy.log))
harness.report("a lost master is an emergency", lost, "no emergency came")
harness.report(
    "and stops the motor",
    harness.wait_until(lambda truth: truth["motors"][0]["duty_raw"] == 0),
    harness.truth()["motors"][0],
)
check("the error register says so", number(sdo.upload(0x1001, 0)), 0x11)

node.nmt.send_command(0x81)
harness.report("a reset is a boot-up", harness.eventually(lambda: 0 in states), f"{states}")

begun = time.monotonic()
for _ in range(100):
    sdo.upload(0x2018, 0)
harness.figure("objects read", 100 / (time.monotonic() - begun), "per second")
network.disconnect()
harness.finish()
