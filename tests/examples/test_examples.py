"""The commands of every example's README run, and its check passes: results go to a folder of the test."""
import importlib.machinery
import importlib.util
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
import harness  # noqa: E402

ROOT, PROGRAM = harness.ROOT, harness.program()
sys.dont_write_bytecode = True


def commands(readme):
    """Those that examples/update runs, without plots and pictures."""
    loader = importlib.machinery.SourceFileLoader("update", str(ROOT / "examples" / "update"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("update", loader))
    loader.exec_module(module)
    lines = [shlex.split(line) for line in module.commands(readme.read_text())]
    return [words for words in lines if words[0] == "build/cpu/cdem" or words[1:] and words[1].endswith("check.py")]


@pytest.mark.parametrize("name", sorted(path.parent.name for path in (ROOT / "examples").glob("*/README.md")))
def test_example(name, tmp_path):
    found = commands(ROOT / "examples" / name / "README.md")
    assert found[0][0] == "build/cpu/cdem" and found[-1][0] == "python3", "a run first, its check last"
    for words in found:
        command = [str(tmp_path / word) if word.startswith("out/") else word for word in words[1:]]
        done = subprocess.run([PROGRAM if words[0] == "build/cpu/cdem" else sys.executable, *command], cwd=ROOT, text=True,
                              env=harness.environment(), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False,
                              timeout=1200)
        assert done.returncode == 0, f"{' '.join(words)}\n{done.stdout[-3000:]}"
