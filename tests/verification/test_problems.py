"""Every problem of the verification table meets its bars."""
import pytest

import problems  # noqa: F401
from problem import PROBLEMS


@pytest.mark.parametrize("case", PROBLEMS, ids=[p.name for p in PROBLEMS])
def test_problem(case, tmp_path, request):
    if case.long and not request.config.getoption("--all", default=False):
        pytest.skip("long: pytest --all")
    rows = case.rows(tmp_path)
    missed = [f"{r.quantity}: exact {r.exact:.12g}, computed {r.computed:.12g}, error {r.error:.3g} > {r.bar:g} [{r.mesh}]"
              for r in rows if not r.good]
    assert rows and not missed, "\n".join(missed)
