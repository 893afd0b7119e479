"""The house: no source file above 400 lines, no circle of includes between the folders of src."""
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
LINES = 400
SUFFIXES = {".cxx", ".hpp", ".cu", ".cuh"}


def sources(*folders):
    return [p for folder in folders for p in sorted((ROOT / folder).rglob("*")) if p.suffix in SUFFIXES]


def folder_includes(root):
    """{folder: {folder it includes: the lines that do}} of the folders below root; files at the root itself are on top."""
    includes = {}
    for path in sorted(root.rglob("*")):
        if path.suffix not in SUFFIXES or path.parent == root:
            continue
        folder = path.relative_to(root).parts[0]
        for line in path.read_text().splitlines():
            found = re.match(r'\s*#\s*include\s+"([^"/]+)/', line)
            if found and found[1] != folder and (root / found[1]).is_dir():
                includes.setdefault(folder, {}).setdefault(found[1], []).append(f"{path.relative_to(root)}: {line.strip()}")
    return includes


def circle(includes):
    """A circle as a list of folders, the first one again at its end; [] if there is none."""
    done = set()

    def walk(folder, path):
        if folder in path:
            return path[path.index(folder):] + [folder]
        if folder not in done:
            for other in includes.get(folder, {}):
                found = walk(other, path + [folder])
                if found:
                    return found
            done.add(folder)
        return []

    for start in includes:
        found = walk(start, [])
        if found:
            return found
    return []


def test_files_are_short():
    files = sources("src", "cuda")
    assert len(files) > 40, "the sources are not where this test looks"
    long = {str(p.relative_to(ROOT)): n for p in files if (n := len(p.read_text().splitlines())) > LINES}
    assert not long, f"above {LINES} lines: {long}"


def test_folders_include_in_one_direction():
    includes = folder_includes(ROOT / "src")
    assert "physics" in includes.get("forces", {}), "no includes were found"
    found = circle(includes)
    lines = [line for a, b in zip(found, found[1:]) for line in includes[a][b]]
    assert not found, " -> ".join(found) + "\n" + "\n".join(lines)


def test_core_stands_alone():
    assert "core" not in folder_includes(ROOT / "src")


@pytest.mark.parametrize("edges, expected", [
    ({}, 0), ({"a": {"b": 1}, "b": {"c": 1}, "d": {"b": 1, "c": 1}}, 0), ({"a": {"b": 1}, "b": {"a": 1}}, 3),
    ({"z": {"a": 1}, "a": {"b": 1}, "b": {"c": 1}, "c": {"a": 1}}, 4)])
def test_circles_are_seen(edges, expected):
    assert len(circle(edges)) == expected
