"""The unit tests of the mesh on several ranks: every part agrees with the whole, stars are complete, faces and names too."""
import os
import subprocess

import pytest

unit = os.path.join(os.environ["CDEM_BUILD"], "tests", "cdem_unit")


@pytest.mark.skipif(not os.path.exists(unit), reason="no unit tests in this build")
@pytest.mark.parametrize("ranks", [2, 3])
def test_mesh(ranks):
    run = subprocess.run(["mpirun", "-np", str(ranks), unit, "--gtest_filter=*Mesh*", "--gtest_brief=1"],
                         cwd=os.path.dirname(unit), capture_output=True, text=True, timeout=600)
    assert run.returncode == 0, run.stdout + run.stderr
