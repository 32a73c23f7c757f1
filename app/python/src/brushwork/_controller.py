"""A controller, simulated or real, by the program's command line."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Mapping

from ._program import ask, run

TUNED_WITH_WARNINGS = 8


@dataclass(frozen=True)
class Identity:
    """Who answered."""

    model: str
    firmware: str
    generation: int | None
    address: int
    simulated: bool
    raw: dict[str, Any] = field(repr=False)

    @classmethod
    def of(cls, data: dict[str, Any]) -> Identity:
        return cls(data["model"], data["firmware"], data.get("generation"), data["address"], data["simulated"], data)


@dataclass(frozen=True)
class Status:
    """What a controller measures and reports."""

    identity: Identity
    readings: dict[str, float | None]
    """By channel: ``main_battery`` in volts, ``m1_velocity`` in counts/s, ``m1_current`` in amperes, ...; ``None``: not told."""
    conditions: list[Any]
    """Errors and warnings that are there now."""
    diagnosis: str | None
    """Why the motors do not run, as far as anything is known."""
    raw: dict[str, Any] = field(repr=False)


@dataclass(frozen=True)
class Sample:
    """One sweep of readings while a motor is driven."""

    time_s: float
    readings: dict[str, float | None]


@dataclass(frozen=True)
class Setting:
    """One setting as it was read."""

    key: str
    title: str
    value: Any
    unit: str
    text: str
    """With its unit, for people."""
    is_default: bool


@dataclass(frozen=True)
class Tuning:
    """What came of a tuning run."""

    verdict: str
    """"tuned", or with warnings to read."""
    causes: list[str]
    """What warnings there are."""
    gain_counts_per_s: float
    """Speed at full duty, of the identified motor."""
    tau_s: float
    """Its time constant."""
    p: float
    i: float
    """Gains of the velocity loop, as the controller shows them."""
    qpps: float | None
    raw: dict[str, Any] = field(repr=False)

    @classmethod
    def of(cls, data: dict[str, Any]) -> Tuning:
        model, gains = data["fit"]["model"], data["design"]["gains"]["velocity"]
        return cls(
            verdict=data["verdict"],
            causes=data["causes"],
            gain_counts_per_s=model["gain_counts_per_s"],
            tau_s=model["tau_s"],
            p=gains["p"],
            i=gains["i"],
            qpps=data["qpps"],
            raw=data,
        )


class Connection:
    """A controller at a place. Nothing is held open between two calls: each is a command of its own, and connecting never moves a motor."""

    def __init__(self, target: str, address: int | None, family: str | None) -> None:
        self.target = target
        self._line = ["--connect", target]
        if address is not None:
            self._line += ["--address", str(address)]
        if family is not None:
            self._line += ["--family", family]

    def status(self) -> Status:
        """Reads what it measures and reports."""
        data = ask(["status", *self._line])
        return Status(Identity.of(data["identity"]), data["readings"], data["conditions"], data["diagnosis"], data)

    def drive(
        self,
        motor: int | str = 1,
        *,
        duty: float | None = None,
        speed: int | None = None,
        position: int | None = None,
        by: int | None = None,
        accel: float | None = None,
        seconds: float = 1.0,
    ) -> list[Sample]:
        """Drives a motor for so long, with exactly one set point, and stops it; gives the readings of that time.

        :param motor: 1, 2 or "both".
        :param duty: percent, -100 to 100.
        :param speed: encoder counts per second.
        :param position: encoder counts.
        :param by: encoder counts from where the motor is.
        :param accel: percent per second with ``duty``, counts/s² with ``speed`` and ``position``.
        :raises Refused: the controller or a safety rule refused, or the motor did not do what it was told. The motors are stopped.
        """
        given = {"--duty": duty, "--speed": speed, "--position": position, "--by": by}
        points = [f"{name}={value}" for name, value in given.items() if value is not None]
        if len(points) != 1:
            raise ValueError("one of duty, speed, position and by")
        more = [] if accel is None else ["--accel", str(accel)]
        words = ["drive", *self._line, "--motor", str(motor), *points, *more, "--for", str(seconds), "--json"]
        _, output = run(words)
        samples = (json.loads(line) for line in output.splitlines())
        return [Sample(sample["time_s"], sample["readings"]) for sample in samples if "readings" in sample]

    def stop(self) -> None:
        """Stops both motors at once, also while another brushwork holds the line.

        :raises BrushworkError: it was not confirmed: cut the motor power.
        """
        ask(["stop", *self._line])

    def settings(self, *keys: str) -> dict[str, Setting]:
        """Reads the settings in its RAM: all, or those whose keys begin so ("motor1.velocity")."""
        rows = ask(["settings", "read", *self._line, *keys])["settings"]
        return {
            row["key"]: Setting(row["key"], row["title"], row["value"], row["unit"], row["text"], row["is_default"]) for row in rows
        }

    def write(self, changes: Mapping[str, Any], *, save: bool = False, dry_run: bool = False) -> dict[str, Any]:
        """Writes settings to RAM, reads them back, and gives the report; a backup is made first.

        :param changes: by key, each in the setting's unit: ``{"motor1.velocity.qpps": 12000}``.
        :param save: save to EEPROM when everything took.
        :param dry_run: only what would change, with the commands and their bytes.
        :raises NotTaken: a value was refused, or did not take.
        """
        pairs = [f"{key}={value}" for key, value in changes.items()]
        flags = ["--dry-run"] if dry_run else ["--yes"]
        report: dict[str, Any] = ask(["settings", "write", *self._line, *pairs, *flags, *(["--save"] if save else [])])
        return report

    def tune_velocity(
        self,
        motor: int = 1,
        *,
        level: float = 50.0,
        max_current: float | None = None,
        apply: bool = False,
        save: bool = False,
        report: str | Path | None = None,
    ) -> Tuning:
        """Measures a motor that may turn freely, and designs its velocity loop. The motor turns, up to full speed.

        :param level: from 0, soft, to 100, stiff.
        :param max_current: amperes; the controller's limit is lowered to it for the run.
        :param apply: leave the new gains in force. :param save: and save all settings to EEPROM.
        :param report: where to write the report, with its raw record, that :func:`replay` reads.
        :raises Refused: no gains were found; the motors are stopped and what was changed is put back.
        """
        words = ["tune", "velocity", *self._line, "--motor", str(motor), "--level", str(level)]
        if max_current is not None:
            words += ["--max-current", str(max_current)]
        if report is not None:
            words += ["--report", str(report)]
        words += ["--save"] if save else ["--apply"] if apply else []
        return Tuning.of(ask(words, accepted=(0, TUNED_WITH_WARNINGS)))


def connect(target: str, *, address: int | None = None, family: str | None = None) -> Connection:
    """A controller at a port: "/dev/ttyACM0", "COM3", "tcp:HOST:PORT", "sim:mcp266", or the ``port`` of a :class:`Simulator`.

    :param address: on its line, by default that of a new unit.
    :param family: "mcp" or "motion-mind"; without it each is looked for in turn.
    """
    return Connection(target, address, family)


def replay(report: str | Path) -> Tuning:
    """Works out the gains of a kept tuning run of a velocity loop once more, from its report."""
    return Tuning.of(ask(["tune", "replay", str(report)], accepted=(0, TUNED_WITH_WARNINGS)))
