"""Options as a YAML scene or as a file of lines, and back again, without anything of the program."""
import re
import shlex

import yaml

HEADS = ("mesh_box", "block", "interface", "boundary", "joint", "history", "table", "monitor", "output", "ts", "velocity", "damping")


class Unreadable(Exception):
    """Not a file of that language."""


def write_lines(options, rng):
    """Lines of `-name value`."""
    out = []
    for name, value in options:
        quote = any(c in value for c in ' "') and '"' not in value
        out.append(f"-{name}" + (f' "{value}"' if quote else f" {value}" if value else ""))
    return "\n".join(["# a scene"] * (rng.random() < 0.5) + out) + "\n"


def _scalar(value, rng):
    if "," in value and re.fullmatch(r"[\w.,+-]+", value) and rng.random() < 0.7:
        return "[" + ", ".join(value.split(",")) + "]"
    if re.search(r"[:#\[\]{}&*!|>'\"%@`,]", value) or value != value.strip():
        return '"' + value.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n") + '"'
    return value


def write_yaml(options, rng):
    """YAML in blocks, flat or nested by family."""
    out, groups = [], {}
    for name, value in options:
        head = next((h for h in HEADS if name.startswith(h + "_")), None)
        if head is None or rng.random() < 0.2:
            out.append(f"{name}: {_scalar(value, rng)}".rstrip())
        else:
            groups.setdefault(head, []).append((name[len(head) + 1:], value))
    for head, parts in groups.items():
        flow = all(v for _, v in parts) and rng.random() < 0.3
        rows = [f"{key}: {_scalar(value, rng)}".rstrip() for key, value in parts]
        out += [f"{head}: {{{', '.join(rows)}}}"] if flow else [f"{head}:"] + ["  " + row for row in rows]
    return "\n".join(out) + "\n"


def read_lines(data):
    """[(name, value or None)] of a file of lines."""
    found = []
    for line in data.decode("utf-8", "surrogateescape").replace("\r", "\n").split("\n"):
        line = re.split(r"[#]", line)[0].strip()
        if not line or line[0] in "!%":
            continue
        if "\x00" in line:
            raise Unreadable("NUL")
        try:
            words = shlex.split(line, posix=True) if '"' in line else line.split()
        except ValueError as error:
            raise Unreadable(str(error))
        if not re.match(r"-[A-Za-z]", words[0]) or len(words) > 2:
            raise Unreadable(f"line {line[:40]!r}")
        found.append((words[0][1:], words[1] if len(words) == 2 else None))
    return found


def read_yaml(data):
    """[(name, value or None)] in the order of the file; keys joined by '_', lists by commas."""
    try:
        text = data.decode("utf-8")
        documents = list(yaml.compose_all(text, Loader=yaml.SafeLoader))
    except (yaml.YAMLError, UnicodeDecodeError, RecursionError) as error:
        raise Unreadable(str(error))
    if len(documents) > 1:
        raise Unreadable("several documents")
    found = []
    for node in documents:
        _walk(node, "", found)
    return found


def _text(node):
    if isinstance(node, yaml.ScalarNode):
        return node.value
    if isinstance(node, yaml.SequenceNode):
        return ",".join(_text(part) for part in node.value)
    raise Unreadable("a mapping in a list")


def _walk(node, prefix, found):
    if not isinstance(node, yaml.MappingNode):
        raise Unreadable("no mapping")
    for key, value in node.value:
        if not isinstance(key, yaml.ScalarNode):
            raise Unreadable("a key that is no word")
        name = prefix + key.value
        if isinstance(value, yaml.MappingNode):
            _walk(value, name + "_", found)
        elif isinstance(value, yaml.ScalarNode) and value.tag == "tag:yaml.org,2002:null" and not value.style:
            found.append((name, value.value or None))
        else:
            found.append((name, _text(value)))
