"""docs/options.md is what the program writes."""
import os
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
CDEM = os.environ.get("CDEM", str(ROOT / "build" / "cpu" / "cdem"))


def options(how):
    return subprocess.run([CDEM, "-help_options", how], check=True, text=True, stdout=subprocess.PIPE).stdout


def test_page_is_current():
    page = (ROOT / "docs" / "options.md").read_text()
    assert options("markdown") == page, "run: cdem -help_options markdown > docs/options.md"


def test_plain_has_units_and_defaults():
    text = options("plain")
    assert "-block_<region>_young: a number [Pa] (required)" in text
    assert "-ts_central_safety: a number (0.9)" in text
