"""Every row of the stability suite meets its bound, with fewer steps than in docs/stability.md."""
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parent))
import joints  # noqa: E402,F401
import linear  # noqa: E402,F401
from suite import CASES  # noqa: E402


@pytest.mark.parametrize("case", CASES, ids=[c.name for c in CASES])
def test_case(case, tmp_path):
    rows, _ = case.rows(tmp_path, quick=True)
    missed = [f"{r.run}: {r.judged}: {r.figure:.3g} > {r.bound:g} {r.note}" for r in rows if not r.good]
    assert rows and not missed, "\n".join(missed)
