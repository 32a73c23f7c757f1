"""Simulated brushed-DC motor controllers for tests, and real ones from Python.

``simulate`` runs a simulated controller on a pseudo-terminal or a TCP port, for any client to talk to::

    with brushwork.simulate("roboclaw-2x30a", generation=4) as sim:
        my_driver = Driver(sim.port)
        ...
        assert sim.truth().axes[0].encoder_counts > 0

``connect`` reads, drives, sets up and tunes a controller, simulated or real, by the program's own command line.
"""

from ._controller import Connection, Identity, Sample, Setting, Status, Tuning, connect, replay
from ._errors import BrushworkError, NotTaken, NoLink, ProgramMissing, Refused
from ._program import program
from ._simulate import AxisTruth, Simulator, Truth, simulate

__all__ = [
    "AxisTruth",
    "BrushworkError",
    "Connection",
    "Identity",
    "NoLink",
    "NotTaken",
    "ProgramMissing",
    "Refused",
    "Sample",
    "Setting",
    "Simulator",
    "Status",
    "Truth",
    "Tuning",
    "connect",
    "program",
    "replay",
    "simulate",
]
