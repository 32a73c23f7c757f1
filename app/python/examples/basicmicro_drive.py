"""The vendor's own library drives a simulated RoboClaw.

    pip install brushwork basicmicro
    python basicmicro_drive.py
"""

from __future__ import annotations

import time

import brushwork
from basicmicro import Basicmicro

ADDRESS = 0x80


def drive(port: str, seconds: float = 1.0) -> int:
    """Turns motor 1 at 3000 counts/s for so long, and gives the encoder's count after it."""
    controller = Basicmicro(port, 38400)
    if not controller.Open():
        raise SystemExit(f"{port} cannot be opened")
    try:
        controller.SpeedM1(ADDRESS, 3000)
        time.sleep(seconds)
        controller.DutyM1(ADDRESS, 0)
        return int(controller.ReadEncM1(ADDRESS)[1])
    finally:
        controller.close()


if __name__ == "__main__":
    with brushwork.simulate("roboclaw-2x30a", generation=4) as sim:
        told = drive(sim.port)
        print(f"the controller tells {told} counts, the simulated encoder has {sim.truth().axes[0].encoder_counts}")
