"""The fixture ``brushwork_simulator``, which pytest finds by itself once the package is installed."""

from __future__ import annotations

from typing import Any, Callable, Iterator

import pytest

from ._simulate import Simulator, simulate


@pytest.fixture
def brushwork_simulator() -> Iterator[Callable[..., Simulator]]:
    """Starts simulated controllers, with the arguments of :func:`brushwork.simulate`, that end with the test."""
    running: list[Simulator] = []

    def begin(*arguments: Any, **named: Any) -> Simulator:
        running.append(simulate(*arguments, **named))
        return running[-1]

    yield begin
    for simulator in running:
        simulator.close()
