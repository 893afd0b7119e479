"""pytest options of the verification problems."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))


def pytest_addoption(parser):
    parser.addoption("--all", action="store_true", help="run the long problems too")
