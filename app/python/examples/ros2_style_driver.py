"""A differential drive as a ROS 2 node has it: velocities in, odometry out, at a fixed rate.

The loop knows nothing of ROS, so that it can be tried without: a node would call ``step`` from its timer with the newest ``cmd_vel`` and
publish what it returns. The controller's time-out stops the motors when the loop dies.

    pip install brushwork basicmicro
    python ros2_style_driver.py
"""

from __future__ import annotations

import math
import time
from dataclasses import dataclass

import brushwork
from basicmicro import Basicmicro

ADDRESS = 0x80
RATE_HZ = 20.0
CMD_VEL_TIMEOUT_S = 0.5


@dataclass
class Odometry:
    """Where the robot is, and how fast: metres, radians."""

    x: float = 0.0
    y: float = 0.0
    heading: float = 0.0


class Driver:
    """Two wheels on the two motors of one controller."""

    def __init__(self, port: str, counts_per_metre: float = 10_000.0, track_metres: float = 0.3) -> None:
        self.counts_per_metre = counts_per_metre
        self.track_metres = track_metres
        self.odometry = Odometry()
        self._controller = Basicmicro(port, 38400)
        if not self._controller.Open():
            raise ConnectionError(f"{port} cannot be opened")
        self._controller.SetTimeout(ADDRESS, 0.5)
        self._last = self._encoders()

    def step(self, linear: float, angular: float, age_s: float) -> Odometry:
        """One turn of the loop: m/s and rad/s of a ``cmd_vel`` that is so old; an old one means stop."""
        if age_s > CMD_VEL_TIMEOUT_S:
            linear = angular = 0.0
        half = angular * self.track_metres / 2
        speeds = [round(side * self.counts_per_metre) for side in (linear - half, linear + half)]
        self._controller.SpeedM1M2(ADDRESS, *speeds)
        now = self._encoders()
        left, right = ((new - old) / self.counts_per_metre for new, old in zip(now, self._last))
        self._last = now
        self.odometry.heading += (right - left) / self.track_metres
        self.odometry.x += (left + right) / 2 * math.cos(self.odometry.heading)
        self.odometry.y += (left + right) / 2 * math.sin(self.odometry.heading)
        return self.odometry

    def close(self) -> None:
        """Stops both motors and gives the port back."""
        self._controller.DutyM1M2(ADDRESS, 0, 0)
        self._controller.close()

    def _encoders(self) -> tuple[int, int]:
        ok, left, right = self._controller.GetEncoders(ADDRESS)
        if not ok:
            raise ConnectionError("the encoders could not be read")
        return int(left), int(right)


def run(driver: Driver, linear: float, angular: float, seconds: float) -> Odometry:
    """Drives for so long at the loop's rate, and stops."""
    end = time.monotonic() + seconds
    try:
        while time.monotonic() < end:
            driver.step(linear, angular, age_s=0.0)
            time.sleep(1 / RATE_HZ)
        return driver.odometry
    finally:
        driver.close()


if __name__ == "__main__":
    with brushwork.simulate("roboclaw-2x30a", generation=4) as sim:
        odometry = run(Driver(sim.port), linear=0.3, angular=0.2, seconds=2.0)
        print(odometry, [axis.encoder_counts for axis in sim.truth().axes])
