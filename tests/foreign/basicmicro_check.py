"""Calls every public method of `basicmicro.Basicmicro` 2.0.10 against the simulator in generation 4.

A setting is written, then looked up in the simulator's own memory, then read back; a motion is judged by what the simulated
machine does. What cannot succeed is listed in EXPECTED_FAILURES with the reason, and must fail for that reason.
"""

import inspect
import random
import sys
import time

from basicmicro import Basicmicro

import harness
from harness import let_silence_be_noticed, truth, wait_until

ADDRESS = 0x80
RETRIES = 20  # the library sends a packet in pieces: on a busy machine the 10 ms gap may fall between two of them

LIBRARY_FLOAT = "the library computes a float duty and then shifts it, which raises TypeError before the packet is complete"
LIBRARY_STUB = "the library keeps a stub that returns False and sends nothing"
LIBRARY_NAME = "the library refers to names of its own class as if they were global (NameError)"

# Method -> why it cannot succeed with this version of the library, whatever the controller does.
EXPECTED_FAILURES = {
    **{name: LIBRARY_FLOAT for name in ("ForwardM1", "BackwardM1", "ForwardM2", "BackwardM2")},
    **{name: LIBRARY_FLOAT for name in ("ForwardBackwardM1", "ForwardBackwardM2")},
    **{name: LIBRARY_STUB for name in ("SetMinVoltageMainBattery", "SetMaxVoltageMainBattery")},
    **{name: LIBRARY_STUB for name in ("SetMinVoltageLogicBattery", "SetMaxVoltageLogicBattery")},
    **{name: LIBRARY_NAME for name in ("decode_error_status", "decode_warning_status", "decode_full_status")},
    "analyze_roboclaw_status": LIBRARY_NAME,
}

# Methods of the object itself; they are called, but they are not among the 159 that speak to the controller.
LOCAL = {"Open", "reconnect", "close", "crc_clear", "crc_update", "SendRandomData", "decode_error_status"} | {
    "decode_warning_status",
    "decode_full_status",
    "analyze_roboclaw_status",
    "print_status_analysis",
}


def unsigned(value):
    """The library reads every 32-bit field as unsigned unless it says otherwise."""
    return value & 0xFFFFFFFF


def word(value):
    return value & 0xFFFF


class Checker:
    """Calls methods by name and keeps the first verdict that is not a success."""

    def __init__(self, device):
        self.device = device
        self.verdicts = {}

    def call(self, name, *arguments):
        """The method's answer, or the exception it raised."""
        try:
            return getattr(self.device, name)(ADDRESS, *arguments)
        except Exception as error:  # the library raises anything from NameError to its own time-out
            return error

    def record(self, name, passed, detail=""):
        if self.verdicts.get(name, (True, ""))[0]:
            self.verdicts[name] = (bool(passed), "" if passed else detail)

    def write(self, name, *arguments):
        """A write that must be acknowledged."""
        answer = self.call(name, *arguments)
        self.record(name, answer is True, f"answered {answer!r}")
        return answer is True

    def read(self, name, expected, *arguments):
        """A read whose values must equal `expected`, computed from the truth after the read."""
        answer = self.call(name, *arguments)
        wanted = expected(truth())
        succeeded = isinstance(answer, tuple) and bool(answer[0])
        self.record(name, succeeded and tuple(answer[1:]) == wanted, f"read {answer!r}, the truth is {wanted!r}")

    def setting(self, writer, arguments, reader, expected):
        """Writes, looks the value up in the simulator, reads it back, and demands that something was changed."""
        before = expected(truth())
        if self.write(writer, *arguments):
            after = expected(truth())
            self.record(writer, after != before, f"left {before!r} as it was")
        self.read(reader, expected)

    def report(self):
        for name, (passed, detail) in sorted(self.verdicts.items()):
            harness.report(name, passed, detail)
        for name in public_methods():
            if name not in self.verdicts:
                harness.report(name, False, "was never called")


def public_methods():
    return [name for name, value in vars(Basicmicro).items() if not name.startswith("_") and inspect.isfunction(value)]


def main():
    path = sys.argv[1]
    device = Basicmicro(path, 115200, timeout=0.2, retries=RETRIES)
    checker = Checker(device)
    check_local_methods(checker)
    factory = truth()["settings"]
    check_settings(checker)
    check_lists(checker)
    check_memory(checker, factory)
    check_measurements(checker)
    check_duty_motion(checker)
    check_speed_motion(checker)
    check_position_motion(checker)
    check_moving_measurements(checker)
    check_can(checker)
    check_estop_and_script(checker)
    check_what_cannot_work(checker)
    device.close()
    checker.report()
    harness.finish()


# ---------------------------------------------------------------------------------------------------------------------
# Methods that do not speak to the controller


def check_local_methods(checker):
    device = checker.device
    checker.record("Open", device.Open() is True, "did not open the pseudo-terminal")
    checker.record("reconnect", device.reconnect() is True, "did not open it again")
    device.close()
    checker.record("close", not device.is_connected)
    device.Open()
    device.crc_clear()
    checker.record("crc_clear", device._crc == 0)
    for byte in (0x80, 0x15):
        device.crc_update(byte)
    checker.record("crc_update", device._crc == 0x590C, f"0x{device._crc:04X}")
    random.seed(1)
    device.SendRandomData(40)
    let_silence_be_noticed()
    answer = device.ReadVersion(ADDRESS)
    checker.record("SendRandomData", answer[0], "the controller did not answer after 40 random bytes")
    status = dict.fromkeys(("combined_status_raw", "error_status_raw", "warning_status_raw"), 0)
    status |= {"has_errors": False, "has_warnings": False, "errors": [], "warnings": []}
    output, sys.stdout = sys.stdout, open("/dev/null", "w", encoding="utf-8")
    try:
        Basicmicro.print_status_analysis(status)
    finally:
        sys.stdout.close()
        sys.stdout = output
    checker.record("print_status_analysis", True)
    checker.read("ReadVersion", lambda t: (t["version"] + "\n",))


# ---------------------------------------------------------------------------------------------------------------------
# Settings with fixed fields


def motor(settings, index):
    return settings["motors"][index]


def velocity_gains(index):
    def expected(t):
        m = motor(t["settings"], index)
        return (*(m[f"velocity_{gain}_raw"] / 65536 for gain in "pid"), m["qpps"])

    return expected


def position_gains(index):
    def expected(t):
        m = motor(t["settings"], index)
        limits = (m["position_max_i"], m["position_deadzone_counts"])
        ends = (unsigned(m["position_min_counts"]), unsigned(m["position_max_counts"]))
        return (*(m[f"position_{gain}_raw"] / 1024 for gain in "pid"), *limits, *ends)

    return expected


def per_motor(*keys):
    """The named raw values, all of motor 1 first."""
    return lambda t: tuple(unsigned(motor(t["settings"], index)[key]) for index in (0, 1) for key in keys)


def of_motor(index, *keys, scale=1):
    return lambda t: tuple(unsigned(motor(t["settings"], index)[key]) / scale for key in keys)


def of_unit(*keys):
    return lambda t: tuple(t["settings"][key] for key in keys)


def pwm_idle(t):
    raw = [motor(t["settings"], index)["pwm_idle_raw"] for index in (0, 1)]
    return tuple(value for byte in raw for value in ((byte & 0x7F) / 10, bool(byte & 0x80)))


def check_settings(checker):
    set_and_read = checker.setting
    set_and_read("SetTimeout", (2.5,), "GetTimeout", lambda t: (t["settings"]["serial_timeout_tenths"] / 10,))
    checker.write("SetTimeout", 0)
    encoder_modes = per_motor("encoder_mode")(truth())
    for index, name in enumerate(("M1", "M2")):
        gains = (1.5 + index, 0.25, 0.125, 20000 + index)
        set_and_read(f"Set{name}VelocityPID", gains, f"Read{name}VelocityPID", velocity_gains(index))
        gains = (2.0 + index, 0.5, 8.0, 100, 3, -100000, 200000)
        set_and_read(f"Set{name}PositionPID", gains, f"Read{name}PositionPID", position_gains(index))
        impedance = of_motor(index, "inductance_raw", "resistance_raw", scale=1 << 24)
        set_and_read(f"Set{name}LR", (0.001 + index, 0.75), f"Get{name}LR", impedance)
        checker.write(f"Set{name}LR", 0, 0)  # both non-zero would turn duty commands into torque commands
        currents = of_motor(index, "max_current_raw", "min_current_raw")
        set_and_read(f"Set{name}MaxCurrent", (2500 + index, 1000), f"Read{name}MaxCurrent", currents)
        accelerations = per_motor("default_accel_raw", "default_decel_raw")
        set_and_read(f"Set{name}DefaultAccel", (200000 + index, 300000), "GetDefaultAccels", accelerations)
        set_and_read(f"Set{name}DefaultSpeed", (16384 + index,), "GetDefaultSpeeds", per_motor("default_speed_raw"))
        set_and_read(f"Set{name}EncoderMode", (1,), "ReadEncoderModes", per_motor("encoder_mode"))
        checker.write(f"Set{name}EncoderMode", encoder_modes[index])
        set_and_read(f"SetAuto{index + 1}", (600 + index,), "GetAutos", per_motor("homing_timeout_ticks"))
    set_and_read("SetMainVoltages", (70, 290, 4), "ReadMinMaxMainVoltages", of_unit(*MAIN_LIMITS))
    set_and_read("SetLogicVoltages", (58, 280), "ReadMinMaxLogicVoltages", of_unit("logic_min_tenths", "logic_max_tenths"))
    set_and_read("SetOffsets", (5, -3), "GetOffsets", of_unit("main_offset_tenths", "logic_offset_tenths"))
    checker.write("SetOffsets", 0, 0)
    set_and_read("SetSpeedErrorLimit", (31000, 32000), "GetSpeedErrorLimit", per_motor("speed_error_limit"))
    checker.write("SetSpeedErrorLimit", 0, 0)
    set_and_read("SetPosErrorLimit", (61000, 62000), "GetPosErrorLimit", per_motor("position_error_limit"))
    checker.write("SetPosErrorLimit", 0, 0)
    set_and_read("SetPWMMode", (0, 1), "ReadPWMMode", per_motor("pwm_mode"))
    set_and_read("SetPWMIdle", (0.5, True, 1.2, False), "GetPWMIdle", pwm_idle)
    checker.write("SetPWMIdle", 0, False, 0, False)
    set_and_read("SetPriority", (1, 3, 2), "GetPriority", lambda t: tuple(t["settings"]["priority"]))
    set_and_read("SetAddressMixed", (0x83, 0), "GetAddressMixed", of_unit("address", "mixed"))
    checker.write("SetAddressMixed", 0x80, 0)
    set_and_read("SetNodeID", (17,), "GetNodeID", of_unit("can_node_id"))
    set_and_read("SetScriptAutoRun", (2500,), "GetScriptAutoRun", of_unit("script_autorun_ms"))
    checker.write("SetScriptAutoRun", 0)
    set_and_read("SetSerialNumber", ("BW-0001-test",), "GetSerialNumber", of_unit("serial_number"))
    set_and_read("SetConfig", (0x00A3,), "GetConfig", of_unit("config_word"))
    set_and_read("SetPinFunctions", (1, 2, 3, 1, 2), "ReadPinFunctions", lambda t: tuple(t["settings"]["pin_functions"]))
    inputs = (3, 4, 1000, 2000, 1500, 900, 2100, 5, 6, 1001, 2001, 1501, 901, 2101)
    set_and_read("SetCtrlSettings", inputs, "GetCtrlSettings", lambda t: tuple(t["settings"]["control_inputs"]))
    set_and_read("SetAuxDutys", (100, 200, 300, 400, 500), "GetAuxDutys", lambda t: tuple(t["aux_duties"]))


MAIN_LIMITS = ("main_min_tenths", "main_max_tenths", "main_auto_offset_tenths")


# ---------------------------------------------------------------------------------------------------------------------
# Settings in lists


def counted(key):
    return lambda t: (len(t["settings"][key]), t["settings"][key])


def signals(t):
    """The library reads the two outputs as unsigned and the rest as the simulator keeps them."""
    records = [dict(record) for record in t["settings"]["signals"]]
    for record in records:
        record |= {key: unsigned(record[key]) for key in ("powerexp", "minout", "maxout")}
    return (len(records), records)


def check_lists(checker):
    checker.setting("SetDOUT", (0, 3), "GetDOUTS", counted("outputs"))
    checker.setting("SetStream", (2, 1, 57600, 750), "GetStreams", counted("streams"))
    fields = {
        "index": 1,
        "signal_type": 1,
        "mode": 0,
        "target": 0,
        "min_action": 0,
        "max_action": 0,
        "lowpass": 4,
        "timeout": 900,
        "loadhome": -77,
        "min_val": 100,
        "max_val": 4000,
        "center": 2100,
        "deadband": 40,
        "powerexp": 65536,
        "minout": -20000,
        "maxout": 30000,
        "powermin": 12,
        "potentiometer": 7,
    }
    checker.setting("SetSignal", tuple(fields.values()), "GetSignals", signals)
    keys = ("command", "position", "percent", "speed", "speeds")
    values = lambda t: (len(t["signals"]), [{key: unsigned(record[key]) for key in keys} for record in t["signals"]])
    checker.read("GetSignalsData", values)


# ---------------------------------------------------------------------------------------------------------------------
# EEPROM


def check_memory(checker, factory):
    # A save keeps what RAM holds; a reload brings it back after a change.
    checker.write("WriteNVM")
    saved = wait_until(lambda t: t["saved_settings"] == t["settings"])
    checker.record("WriteNVM", saved, "the EEPROM does not hold what RAM holds")
    checker.write("SetNodeID", 99)
    checker.write("ReadNVM")
    reloaded = wait_until(lambda t: t["settings"] == t["saved_settings"])
    checker.record("ReadNVM", reloaded, "RAM does not hold what the EEPROM holds")

    checker.write("WriteEeprom", 5, 0xA55A)
    held = wait_until(lambda t: t["user_memory"][5] == 0xA55A)
    checker.record("WriteEeprom", held, "the word is not in the user memory")
    checker.read("ReadEeprom", lambda t: (t["user_memory"][5],), 5)

    checker.write("RestoreDefaults")
    restored = wait_until(lambda t: t["settings"] == factory)
    checker.record("RestoreDefaults", restored, "RAM does not hold the factory settings")


# ---------------------------------------------------------------------------------------------------------------------
# Measurements at rest


def check_measurements(checker):
    checker.write("DutyM1M2", 0, 0)
    wait_until(lambda t: all(abs(m["speed_counts_per_s"]) < 1 for m in t["motors"]))
    checker.write("SetEncM1", 123456)
    checker.write("SetEncM2", unsigned(-4321))
    counts = lambda t: tuple(unsigned(m["encoder_counts"]) for m in t["motors"])
    checker.record("SetEncM1", counts(truth())[0] == 123456, f"{counts(truth())}")
    checker.record("SetEncM2", counts(truth())[1] == unsigned(-4321), f"{counts(truth())}")
    checker.read("GetEncoders", counts)
    for index, name in enumerate(("M1", "M2")):
        checker.read(f"ReadEnc{name}", lambda t, i=index: (counts(t)[i], t["motors"][i]["encoder_status"]))
        checker.read(f"ReadSpeed{name}", lambda t, i=index: (0, t["motors"][i]["speed_status"]))
        checker.read(f"ReadISpeed{name}", lambda t, i=index: (0, t["motors"][i]["speed_status"]))
    checker.write("ResetEncoders")
    checker.record("ResetEncoders", counts(truth()) == (0, 0), f"{counts(truth())}")
    checker.read("GetEncStatus", lambda t: tuple(m["encoder_status"] for m in t["motors"]))
    checker.read("ReadMainBatteryVoltage", lambda t: (t["main_tenths"],))
    checker.read("ReadLogicBatteryVoltage", lambda t: (t["logic_tenths"],))
    checker.read("GetVolts", lambda t: (t["main_tenths"], t["logic_tenths"]))
    checker.read("ReadTemp", lambda t: (word(t["temperature_tenths"][0]),))
    checker.read("ReadTemp2", lambda t: (word(t["temperature_tenths"][1]),))
    checker.read("GetTemps", lambda t: tuple(word(tenths) for tenths in t["temperature_tenths"]))
    checker.read("ReadError", lambda t: (t["status_word"],))


# ---------------------------------------------------------------------------------------------------------------------
# Motion, judged by the machine


def stop(checker):
    checker.call("DutyM1M2", 0, 0)
    wait_until(lambda t: all(abs(m["speed_counts_per_s"]) < 20 for m in t["motors"]))
    checker.call("ResetEncoders")


def moves(checker, name, arguments, reached):
    """A motion command: acknowledged, and `reached(truth)` holds in time. Both motors are stopped afterwards."""
    go = lambda: checker.write(name, *arguments)
    passed = harness.reached(go, reached, lambda: checker.call("ReadBuffers"))
    checker.record(name, passed, f"the machine did not follow {arguments}: {truth()['motors']}")
    stop(checker)


def duties(first, second):
    return lambda t: [m["duty_raw"] for m in t["motors"]] == [first, second]


def check_duty_motion(checker):
    moves(checker, "DutyM1", (8000,), duties(8000, 0))
    moves(checker, "DutyM2", (-8000,), duties(0, -8000))
    moves(checker, "DutyM1M2", (6000, -7000), duties(6000, -7000))
    moves(checker, "DutyAccelM1", (300000, 9000), duties(9000, 0))
    moves(checker, "DutyAccelM2", (300000, -9000), duties(0, -9000))
    moves(checker, "DutyAccelM1M2", (300000, 5000, 200000, -6000), duties(5000, -6000))

    # The mixed commands of the library need a drive and a turn value before they send anything.
    half = 64 * 32767 // 127
    for drive, sign in (("ForwardMixed", 1), ("BackwardMixed", -1)):
        checker.device._ST_Power = checker.device._ST_Turn = -128
        checker.call("TurnRightMixed", 0)
        moves(checker, drive, (64,), duties(sign * half, sign * half))
    for turn, sign in (("TurnRightMixed", 1), ("TurnLeftMixed", -1)):
        checker.device._ST_Power = checker.device._ST_Turn = -128
        checker.call("ForwardMixed", 0)
        moves(checker, turn, (64,), duties(sign * half, -sign * half))
    quarter = (96 * 2 - 128) * 32767 // 127
    checker.device._ST_Power = checker.device._ST_Turn = -128
    checker.call("LeftRightMixed", 64)
    moves(checker, "ForwardBackwardMixed", (96,), duties(quarter, quarter))
    checker.device._ST_Power = checker.device._ST_Turn = -128
    checker.call("ForwardBackwardMixed", 64)
    moves(checker, "LeftRightMixed", (96,), duties(quarter, -quarter))


def near(value, target, share=0.1):
    return abs(value - target) <= abs(target) * share


def speeds(first, second):
    def reached(t):
        found = [m["speed_counts_per_s"] for m in t["motors"]]
        return all(near(value, target) if target else abs(value) < 20 for value, target in zip(found, (first, second)))

    return reached


def full_speed(checker):
    """Speed at 100 % duty, as a person would find QPPS: run and look."""
    found = [[0.0, 0.0]]

    def steady(t):
        found.append([m["speed_counts_per_s"] for m in t["motors"]])
        time.sleep(0.1)
        return all(near(now, before, 0.001) and now > 100 for now, before in zip(found[-1], found[-2]))

    go = lambda: checker.call("DutyM1M2", 32767, 32767) is True
    checker.record("DutyM1M2", harness.reached(go, steady, lambda: checker.call("ReadBuffers")), f"unsteady: {found[-5:]}")
    found = found[-1]
    stop(checker)
    return int(min(found))


def check_speed_motion(checker):
    qpps = full_speed(checker)
    checker.call("SetM1VelocityPID", 1.0, 0.5, 0.0, qpps)
    checker.call("SetM2VelocityPID", 1.0, 0.5, 0.0, qpps)
    v, w, a = qpps // 4, -qpps // 5, qpps * 2
    moves(checker, "SpeedM1", (v,), speeds(v, 0))
    moves(checker, "SpeedM2", (w,), speeds(0, w))
    moves(checker, "SpeedM1M2", (v, w), speeds(v, w))
    moves(checker, "SpeedAccelM1", (a, v), speeds(v, 0))
    moves(checker, "SpeedAccelM2", (a, w), speeds(0, w))
    moves(checker, "SpeedAccelM1M2", (a, v, w), speeds(v, w))
    moves(checker, "SpeedAccelM1M2_2", (a, v, a, w), speeds(v, w))
    check_distances(checker, v, w, a)


def travelled(first, second):
    def reached(t):
        found = [m["encoder_counts"] for m in t["motors"]]
        return all(abs(value - target) <= max(abs(target) // 10, 20) for value, target in zip(found, (first, second)))

    return reached


def check_distances(checker, v, w, a):
    d = abs(v) // 2
    moves(checker, "SpeedDistanceM1", (v, d, 1), travelled(d, 0))
    moves(checker, "SpeedDistanceM2", (w, d, 1), travelled(0, -d))
    moves(checker, "SpeedDistanceM1M2", (v, d, w, d, 1), travelled(d, -d))
    moves(checker, "SpeedAccelDistanceM1", (a, v, d, 1), travelled(d, 0))
    moves(checker, "SpeedAccelDistanceM2", (a, w, d, 1), travelled(0, -d))
    moves(checker, "SpeedAccelDistanceM1M2", (a, v, d, w, d, 1), travelled(d, -d))
    moves(checker, "SpeedAccelDistanceM1M2_2", (a, v, d, a, w, d, 1), travelled(d, -d))

    # One executes and three wait: 47 says so, and so does the simulator.
    for _ in range(4):
        checker.call("SpeedDistanceM1", v // 4, d, 0)
    checker.read("ReadBuffers", lambda t: tuple(m["buffer"] for m in t["motors"]))
    stop(checker)


def check_position_motion(checker):
    span = 4 * max(motor(truth()["settings"], 0)["qpps"] // 8, 100)
    for name in ("M1", "M2"):
        checker.call(f"Set{name}PositionPID", 8.0, 0.0, 0.0, 0, 0, -span, span)
    p, v, a = span // 4, span // 2, span * 4
    percent = 32767 // 4
    moves(checker, "SpeedAccelDeccelPositionM1", (a, v, a, p, 1), travelled(p, 0))
    moves(checker, "SpeedAccelDeccelPositionM2", (a, v, a, unsigned(-p), 1), travelled(0, -p))
    moves(checker, "SpeedAccelDeccelPositionM1M2", (a, v, a, p, a, v, a, unsigned(-p), 1), travelled(p, -p))
    moves(checker, "PositionM1", (p, 1), travelled(p, 0))
    moves(checker, "PositionM2", (unsigned(-p), 1), travelled(0, -p))
    moves(checker, "PositionM1M2", (p, unsigned(-p), 1), travelled(p, -p))
    moves(checker, "SpeedPositionM1", (v, p, 1), travelled(p, 0))
    moves(checker, "SpeedPositionM2", (v, unsigned(-p), 1), travelled(0, -p))
    moves(checker, "SpeedPositionM1M2", (v, p, v, unsigned(-p), 1), travelled(p, -p))
    moves(checker, "PercentPositionM1", (percent, 1), travelled(span // 4, 0))
    moves(checker, "PercentPositionM2", (-percent, 1), travelled(0, -span // 4))
    moves(checker, "PercentPositionM1M2", (percent, -percent, 1), travelled(span // 4, -span // 4))


# ---------------------------------------------------------------------------------------------------------------------
# Measurements in motion: within the range that the truth visits around the read


def signed(value, bits=32):
    return value - (1 << bits) if value >> (bits - 1) & 1 else value


def sampled(checker, wanted, samples=25):
    """The lowest and the highest of each quantity over some control ticks."""
    rows = []
    for sample in range(samples):
        rows.append(wanted(truth()))
        time.sleep(0.002)
        if sample % 8 == 0:
            checker.call("ReadBuffers")  # keeps the controller's own time-out from stopping the motors
    return [(min(column), max(column)) for column in zip(*rows)]


def live_read(checker, name, found, wanted, steps):
    """A read of moving quantities. `steps` are what the wire rounds each of them to."""
    before = sampled(checker, wanted)
    answer = checker.call(name)
    after = sampled(checker, wanted)
    succeeded = isinstance(answer, tuple) and bool(answer[0])
    values = found(answer) if succeeded else []
    ranges = [(min(b[0], a[0]) - step, max(b[1], a[1]) + step) for b, a, step in zip(before, after, steps)]
    inside = len(values) == len(ranges) and all(low <= value <= high for value, (low, high) in zip(values, ranges))
    checker.record(name, inside, f"read {values!r}, the truth went through {ranges!r}")


def run_on(checker, seconds):
    """Lets the motors run; the reads keep the controller's own time-out of one second from stopping them."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        checker.call("ReadBuffers")
        time.sleep(0.1)


TICK_COUNTS_PER_S = 300  # commands 30, 31 and 79 count whole encoder counts in 1/300 s
AVERAGE_COUNTS_PER_S = 30  # one count more or less, and what the speed did before the first sample


def check_moving_measurements(checker):
    checker.call("SpeedM1M2", 2000, -1500)
    run_on(checker, 2.0)
    of = lambda key: lambda t: [m[key] for m in t["motors"]]
    rest = lambda answer: [signed(value) for value in answer[1:]]
    low_words = lambda answer: [signed(value, 16) for value in answer[1:]]
    live_read(checker, "GetEncoders", rest, of("encoder_counts"), (0, 0))
    live_read(checker, "GetSpeeds", rest, of("speed_counts_per_s"), (AVERAGE_COUNTS_PER_S,) * 2)
    live_read(checker, "GetISpeeds", rest, of("speed_counts_per_s"), (TICK_COUNTS_PER_S,) * 2)
    live_read(checker, "ReadPWMs", lambda answer: list(answer[1:]), of("duty_raw"), (1, 1))
    live_read(checker, "ReadCurrents", lambda answer: list(answer[1:]), of("current_hundredths"), (1, 1))
    live_read(checker, "GetSpeedErrors", low_words, of("speed_error_counts_per_s"), (0, 0))
    live_read(checker, "GetPosErrors", low_words, of("position_error_counts"), (0, 0))
    check_whole_status(checker)
    stop(checker)


def check_whole_status(checker):
    """Command 73 carries everything at once; each field is compared with its own truth."""

    def found(answer):
        _tick, status, *rest = answer[1:]
        words, longs, errors = rest[:8], rest[8:14], rest[14:]
        return [status, *(signed(v, 16) for v in words), *(signed(v) for v in longs), *(signed(v, 16) for v in errors)]

    def wanted(t):
        both = lambda key: [m[key] for m in t["motors"]]
        supply = [*t["temperature_tenths"], t["main_tenths"], t["logic_tenths"]]
        fast = [*both("duty_raw"), *both("current_hundredths"), *both("encoder_counts")]
        speeds = both("speed_counts_per_s") * 2
        errors = [*both("speed_error_counts_per_s"), *both("position_error_counts")]
        return [t["status_word"], *supply, *fast, *speeds, *errors]

    slow, fast = (0, 0, 0, 1, 1), (1, 1, 1, 1, 0, 0)
    speed = (AVERAGE_COUNTS_PER_S,) * 2 + (TICK_COUNTS_PER_S,) * 2
    live_read(checker, "GetStatus", found, wanted, slow + fast + speed + (0, 0, 0, 0))


# ---------------------------------------------------------------------------------------------------------------------
# CAN, E-stop, script


def check_can(checker):
    checker.read("CANGetESR", lambda t: (t["can_error_state"],))
    # The simulated CAN port hears itself: what is put comes back once, then the queue is empty.
    checker.write("CANPutPacket", 0x181, 0, [1, 2, 3, 4])
    for wanted in ((True, True, 0x181, 0, 4, [1, 2, 3, 4, 0, 0, 0, 0]), (True, False, 0, 0, 0, [])):
        answer = checker.call("CANGetPacket")
        checker.record("CANGetPacket", answer == wanted, f"{answer!r} instead of {wanted!r}")

    node = truth()["settings"]["can_node_id"]
    written = checker.call("CANOpenWriteLocalDict", node, 0x6040, 0, 4242, 2)
    checker.record("CANOpenWriteLocalDict", written == (True, 0), f"{written!r}")
    for index, value in ((0x6040, 4242), (0x2000 + 151, node)):  # 151 reads the node id
        read = checker.call("CANOpenReadLocalDict", node, index, 0)
        checker.record("CANOpenReadLocalDict", isinstance(read, tuple) and read[:2] == (True, value), f"{read!r}")


def check_estop_and_script(checker):
    lock = of_unit("estop_lock")
    for state in (Basicmicro.ESTOP_SW_RESET, Basicmicro.ESTOP_AUTO_RESET, Basicmicro.ESTOP_HW_RESET):
        checker.setting("SetEStopLock", (state,), "GetEStopLock", lock)
    checker.write("SetEStopLock", Basicmicro.ESTOP_SW_RESET)
    harness.act("press_estop")
    wait_until(lambda t: t["estop"])
    harness.act("release_estop")
    wait_until(lambda t: not t["estop_pressed"])
    checker.record("ResetEStop", truth()["estop"], "the E-stop did not latch with the lock at software reset")
    checker.write("ResetEStop")
    checker.record("ResetEStop", wait_until(lambda t: not t["estop"]), "the E-stop is still latched")
    checker.write("StartScript")
    checker.write("StopScript")


def check_what_cannot_work(checker):
    for name in EXPECTED_FAILURES:
        checker.verdicts.pop(name, None)
        answer = call_doomed(checker, name)
        worked = answer is True or (isinstance(answer, dict) and answer.get("read_success"))
        checker.record(name, worked, f"{EXPECTED_FAILURES[name]}: {answer!r}")
    let_silence_be_noticed()


def call_doomed(checker, name):
    if name in ("decode_error_status", "decode_warning_status", "decode_full_status"):
        try:
            return bool(getattr(Basicmicro, name)(3))
        except NameError as error:
            return error
    if name == "analyze_roboclaw_status":
        return checker.device.analyze_roboclaw_status(ADDRESS)
    return checker.call(name, 64)


if __name__ == "__main__":
    main()
