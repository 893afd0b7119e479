"""A run that stops and goes on equals a straight one, its energy balance too, to the last bit, on any number of ranks;
the summary has it; and a run that becomes unstable leaves its last good state."""
import json

import pytest

import test_restart as restart
from test_restart import harness

ENERGY = {"monitor_energy": "ascii:energy.txt", "monitor_energy_interval": 10}


def rows(path):
    lines = path.read_text().splitlines()
    names = lines[0].split()[1:]
    return [dict(zip(names, line.split())) for line in lines[1:]]


@pytest.mark.parametrize("seed", range(restart.WATCHED))
def test_restart_keeps_the_balance(seed, tmp_path):
    parts, energy = [], tmp_path / "parts" / "energy.txt"
    restart.straight_and_interrupted(seed, tmp_path, ENERGY, lambda: parts.append(rows(energy)))
    straight, first, second = rows(tmp_path / "straight" / "energy.txt"), parts[0], rows(energy)
    free = {"form", "momentum_x", "momentum_y", "momentum_z"}  # summed in the order of the ranks
    compared = 0
    for part in (first, second):
        for row in part:
            wanted = [other for other in straight if other["step"] == row["step"]]
            for other in wanted:
                compared += 1
                assert {k: v for k, v in row.items() if k not in free} == {k: v for k, v in other.items() if k not in free}
    assert compared >= len(straight)
    assert max(float(row["error"]) for row in straight) < 1e-10
    summary = json.loads((tmp_path / "parts" / "out" / "summary.json").read_text())
    for name, value in second[-1].items():
        if name in summary["energy"] and name not in free:
            assert summary["energy"][name] == float(value)
    assert summary["energy"]["error"] < 1e-10


def test_without_the_monitor_the_error_is_null(tmp_path):
    options, _ = restart.scene(0)
    out = harness.run(tmp_path, options).out
    energy = json.loads((out / "summary.json").read_text())["energy"]
    assert energy["error"] is None and "plastic" not in energy
