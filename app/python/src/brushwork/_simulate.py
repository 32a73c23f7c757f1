"""Simulated controllers with simulated motors, for other people's tests."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Iterable, Sequence

from ._errors import BrushworkError, failure
from ._program import start

START_LIMIT_S = 30.0
"""So long may a simulated controller take until it answers."""

WITHOUT_CONTROL = "motion-mind"
"""Models of this family take no commands while they run."""

TRUTH_LIMIT_S = 10.0
"""So long may it take to write its truth, which it does ten times a second."""


@dataclass(frozen=True)
class AxisTruth:
    """What a motor and its load really do, whatever the controller says of them."""

    encoder_counts: int
    motor_radians: float
    motor_radians_per_second: float
    load_radians: float
    load_radians_per_second: float
    amps: float
    load_newton_metres: float
    shaft_locked: bool
    duty: float | None
    """What the controller's bridge puts out, -1 to 1; ``None`` where it lets the motor go or brakes it."""

    @classmethod
    def of(cls, data: dict[str, Any]) -> AxisTruth:
        truth, output = data["truth"], data["output"]
        return cls(
            encoder_counts=data["encoder_counts"],
            duty=output.get("Duty") if isinstance(output, dict) else None,
            **{name: truth[name] for name in _OF_TRUTH},
        )


_OF_TRUTH = (
    "motor_radians",
    "motor_radians_per_second",
    "load_radians",
    "load_radians_per_second",
    "amps",
    "load_newton_metres",
    "shaft_locked",
)


@dataclass(frozen=True)
class Truth:
    """One simulated unit at one moment."""

    time_s: float
    """Since the simulation began."""
    powered: bool
    battery_volts: float
    axes: tuple[AxisTruth, ...]
    raw: dict[str, Any] = field(repr=False)
    """All of it, as ``brushwork sim --truth`` writes it."""

    @classmethod
    def of(cls, data: dict[str, Any]) -> Truth:
        now = data["now"]
        return cls(
            time_s=now["secs"] + now["nanos"] * 1e-9,
            powered=data["powered"],
            battery_volts=data["battery_volts"],
            axes=tuple(AxisTruth.of(axis) for axis in data["axes"]),
            raw=data,
        )


class Simulator:
    """A running simulated controller, or several on one line. Made by :func:`simulate`; ends when its ``with`` block does."""

    def __init__(self, arguments: Sequence[str], transport: str) -> None:
        if transport not in ("pty", "tcp"):
            raise ValueError(f"transport is 'pty' or 'tcp', not {transport!r}")
        self._folder = tempfile.TemporaryDirectory(prefix="brushwork-")
        self._truth = Path(self._folder.name) / "truth.json"
        self._said = Path(self._folder.name) / "said.txt"
        place = Path(self._folder.name) / "port"
        where = ["--pty", str(place)] if transport == "pty" else ["--tcp", "127.0.0.1:0"]
        with self._said.open("w") as said:
            self._process = start(
                ["sim", *arguments, *where, "--truth", str(self._truth)],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=said,
            )
        try:
            self.port = self._place()
        except BaseException:
            self.close()
            raise

    port: str
    """Where clients find it: the path of a pseudo-terminal, or ``tcp:127.0.0.1:PORT``."""

    @property
    def host_and_port(self) -> tuple[str, int]:
        """The TCP address, for clients that want a socket."""
        if not self.port.startswith("tcp:"):
            raise ValueError("this simulator is on a pseudo-terminal: simulate(..., transport='tcp')")
        host, number = self.port[len("tcp:") :].rsplit(":", 1)
        return host, int(number)

    def truth(self, unit: int = 0) -> Truth:
        """What the simulated unit really does, of a moment after this call began."""
        return self.truths()[unit]

    def truths(self) -> list[Truth]:
        """The same for every unit on the line."""
        asked = time.time_ns()
        end = time.monotonic() + TRUTH_LIMIT_S
        # Clocks of file systems are coarse: what was written twice since the call is newer than the call.
        versions: set[int] = set()
        while time.monotonic() < end:
            self._must_run()
            try:
                written = self._truth.stat().st_mtime_ns
                if written >= asked:
                    versions.add(written)
                if len(versions) > 1:
                    return [Truth.of(unit) for unit in json.loads(self._truth.read_text(encoding="utf-8"))]
            except (OSError, ValueError):
                pass  # It is just being replaced.
            time.sleep(0.01)
        raise BrushworkError(f"the simulator wrote no truth for {TRUTH_LIMIT_S:.0f} s", 1)

    def power_off(self, unit: int | None = None) -> None:
        """Takes the unit's power away; settings that were not saved are lost. Not of a Motion Mind."""
        self._say("power off", unit)

    def power_on(self, unit: int | None = None) -> None:
        """Gives it power again."""
        self._say("power on", unit)

    def power_cycle(self, unit: int | None = None) -> None:
        """Off and on."""
        self._say("power cycle", unit)

    def close(self) -> None:
        """Ends it. Whoever is connected loses the line."""
        if self._process.poll() is None:
            self._process.terminate()
        for pipe in (self._process.stdin, self._process.stdout):
            if pipe is not None:
                pipe.close()
        self._process.wait()
        self._folder.cleanup()

    def __enter__(self) -> Simulator:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _say(self, words: str, unit: int | None) -> None:
        self._must_run()
        stdin = self._process.stdin
        assert stdin is not None
        stdin.write(words if unit is None else f"{words} {unit + 1}")
        stdin.write("\n")
        stdin.flush()

    def _place(self) -> str:
        """Waits for the first line, which says where it is served: "... on tcp:127.0.0.1:41234"."""
        stdout = self._process.stdout
        assert stdout is not None
        line = stdout.readline().strip()
        place = line.rpartition(" on ")[2]
        if not place:
            self._process.wait(START_LIMIT_S)
            self._must_run()
        return place

    def _must_run(self) -> None:
        if self._process.poll() is not None:
            if not self._said.exists():
                raise BrushworkError("this simulator was closed", 1)
            raise failure(self._process.returncode, self._said.read_text(encoding="utf-8"))


def simulate(
    model: str = "mcp266",
    *,
    generation: int = 1,
    preset: str | Sequence[str] = (),
    faults: Iterable[str] = (),
    address: int | str | None = None,
    seed: int = 1,
    transport: str | None = None,
    options: Sequence[str] = (),
) -> Simulator:
    """Starts a simulated controller; use it in a ``with`` block.

    :param model: one of ``brushwork sim --list``: "mcp266", "roboclaw-2x30a", "motion-mind-3", ...
    :param generation: of the firmware, 1 to 4: widths and meanings of the replies.
    :param preset: the motors: one for both, or one for each: "flywheel", "arm-joint", ...
    :param faults: as ``brushwork sim --help`` has them: "drop=0.01", "plant:locked-shaft@4s,motor=1", ...
    :param address: 0x80 for one, or "0x80-0x84" for several units on one line.
    :param seed: of noise and faults: the same seed, the same noise.
    :param transport: "pty" for a serial port, "tcp" for a socket; a pseudo-terminal where there are any (not on Windows).
    :param options: further arguments of ``brushwork sim``.
    :raises BrushworkError: the program's sentence, where it cannot simulate that.
    """
    presets = [preset] if isinstance(preset, str) else list(preset)
    arguments = ["--model", model, "--generation", str(generation), "--seed", str(seed)]
    if presets:
        arguments += ["--preset", ",".join(presets)]
    if address is not None:
        arguments += ["--address", str(address)]
    for fault in faults:
        arguments += ["--fault", fault]
    if not model.startswith(WITHOUT_CONTROL):
        arguments.append("--control")
    usual = "tcp" if sys.platform == "win32" or os.name != "posix" else "pty"
    return Simulator([*arguments, *options], transport or usual)
