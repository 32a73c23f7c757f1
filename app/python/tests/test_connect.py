"""A controller by the command line, from Python."""

import math
from pathlib import Path

import brushwork
import pytest

REPORTS = Path(__file__).resolve().parents[3] / "tests" / "reports"


@pytest.fixture(autouse=True)
def own_files(tmp_path, monkeypatch):
    """Backups and notes of a test are its own."""
    monkeypatch.setenv("BRUSHWORK_DATA_DIR", str(tmp_path))


def test_driving_moves_the_motor_and_leaves_it_standing(brushwork_simulator):
    sim = brushwork_simulator("mcp266", transport="tcp")
    samples = brushwork.connect(sim.port).drive(motor=1, duty=20, seconds=0.5)
    velocities = [sample.readings["m1_velocity"] for sample in samples]
    assert max(velocity for velocity in velocities if velocity is not None) > 500
    axes = sim.truth().axes
    assert axes[0].encoder_counts > 100 and axes[1].encoder_counts == 0
    assert axes[0].duty == 0.0


def test_a_motor_that_is_held_is_refused_with_a_sentence(brushwork_simulator):
    sim = brushwork_simulator("mcp266", transport="tcp", faults=["plant:locked-shaft,motor=1"])
    with pytest.raises(brushwork.Refused, match="blocked"):
        brushwork.connect(f"{sim.port},stream=usb").drive(motor=1, speed=3000, seconds=60)
    assert sim.truth().axes[0].duty == 0.0


def test_one_set_point_is_wanted():
    with pytest.raises(ValueError):
        brushwork.connect("sim:mcp266").drive(duty=1, speed=1)


def test_settings_are_read_written_and_read_back(brushwork_simulator):
    # On a busy computer a pseudo-terminal may be late.
    unit = brushwork.connect(brushwork_simulator("mcp266").port + ",latency=4000")
    before = unit.settings("motor1.velocity")
    assert before["motor1.velocity.qpps"].is_default
    planned = unit.write({"motor1.velocity.qpps": 12000}, dry_run=True)
    assert planned["dry_run"] and planned["changes"][0]["after"] == 12000
    assert unit.settings("motor1.velocity") == before
    unit.write({"motor1.velocity.qpps": 12000})
    assert unit.settings("motor1.velocity.qpps")["motor1.velocity.qpps"].value == 12000


def test_a_value_out_of_range_is_refused(brushwork_simulator):
    unit = brushwork.connect(brushwork_simulator("mcp266", transport="tcp").port)
    with pytest.raises(brushwork.NotTaken, match="qpps|QPPS"):
        unit.write({"motor1.velocity.qpps": -5})


def test_stop_is_confirmed_and_a_dead_line_is_told(brushwork_simulator):
    sim = brushwork_simulator("mcp266", transport="tcp")
    brushwork.connect(sim.port).stop()
    sim.close()
    with pytest.raises(brushwork.NoLink):
        brushwork.connect(sim.port).status()


def test_a_kept_tuning_run_gives_its_gains_again():
    tuning = brushwork.replay(REPORTS / "velocity.json")
    assert tuning.verdict == "tuned" and tuning.causes == []
    assert tuning.tau_s == pytest.approx(0.0596, abs=0.0001)
    assert tuning.p > 0 and tuning.i > 0 and math.isclose(tuning.qpps, 8986.5, abs_tol=0.1)
