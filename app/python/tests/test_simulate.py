"""A simulated controller as another project's tests use it."""

import os
import time
from pathlib import Path

import brushwork
import pytest


def wait_for(holds, limit_s=20.0):
    end = time.monotonic() + limit_s
    while not holds():
        assert time.monotonic() < end, "it never came about"
        time.sleep(0.01)


def test_a_simulated_roboclaw_answers_at_its_port_and_tells_its_truth():
    with brushwork.simulate("roboclaw-2x30a", generation=4) as sim:
        assert Path(sim.port).exists()
        # On a busy computer a pseudo-terminal may be late.
        status = brushwork.connect(f"{sim.port},latency=4000").status()
        assert "2x30" in status.identity.model
        assert status.identity.generation == 4
        truth = sim.truth()
        assert truth.powered and len(truth.axes) == 2
        assert truth.axes[0].encoder_counts == 0 and truth.axes[0].duty == 0.0
        assert truth.time_s > 0.0
        assert sim.truth().time_s > truth.time_s
    assert not Path(sim.port).exists()


def test_over_tcp_it_is_the_same(brushwork_simulator):
    sim = brushwork_simulator("mcp266", transport="tcp")
    host, port = sim.host_and_port
    assert host == "127.0.0.1" and port > 0
    assert brushwork.connect(sim.port).status().identity.model == "MCP266"


def test_a_fault_from_the_start_is_there(brushwork_simulator):
    sim = brushwork_simulator("mcp266", faults=["plant:locked-shaft,motor=1", "plant:battery=13"])
    truth = sim.truth()
    assert [axis.shaft_locked for axis in truth.axes] == [True, False]
    assert truth.battery_volts == pytest.approx(13.0)


def test_its_power_can_be_cut_and_given_back(brushwork_simulator):
    sim = brushwork_simulator("mcp266")
    sim.power_off()
    wait_for(lambda: not sim.truth().powered)
    with pytest.raises(brushwork.NoLink):
        brushwork.connect(sim.port).status()
    sim.power_on()
    wait_for(lambda: sim.truth().powered)


def test_several_units_share_a_line(brushwork_simulator):
    sim = brushwork_simulator("mcp266", address="0x80-0x82")
    assert len(sim.truths()) == 3
    assert brushwork.connect(sim.port, address=0x82).status().identity.address == 0x82


def test_what_cannot_be_simulated_is_refused_with_the_programs_sentence():
    with pytest.raises(brushwork.BrushworkError, match="no-such-model") as refused:
        brushwork.simulate("no-such-model")
    assert refused.value.code == 2


def test_nothing_of_it_is_left_when_it_is_closed():
    sim = brushwork.simulate("motion-mind-3")
    folder = os.path.dirname(sim.port)
    sim.close()
    assert not os.path.exists(folder)
    with pytest.raises(brushwork.BrushworkError, match="closed"):
        sim.truth()
