"""The chart of run time against error: its picture, its tables, and what they say of the defaults."""
import math

import report
from chart_peers import AKANTU, ASSEMBLED, DIRECT
from chart_problems import DEFAULT

AT = 0.01     # the error at which run times are compared
NOISE = 0.75  # run times whose ratio is between this and its inverse count as alike
CAVEATS = [
    "The chart knows linear elasticity and cubes. `onepoint` bends as the beam does because its elements are cubes and nu = 0: flatter ones miss",
    "by more ([forms.md](forms.md)), and it has one stress point. Tetrahedra of `bbar` are meant for plastic flow, where those of full integration",
    "lock ([verification.md](../verification.md), strip footing). Faces that are springs are what an interface that may break needs; their",
    "compliance is an error of its own here, which no mesh takes away, only a larger factor."]
PEERS = {ASSEMBLED: ("k", "--", "s"), AKANTU: ("0.45", "--", "D"), DIRECT: ("k", ":", "*")}


def first_upper(text):
    return text[0].upper() + text[1:]


def time_at(points, at=AT):
    """Run time at an error, on straight lines of the logarithms, where the finer meshes stay below it: seconds and what it
    rests on, or None where no mesh gets there."""
    points = sorted(points, key=lambda p: p["n"])
    below = len(points)
    while below and points[below - 1]["error"] <= at:
        below -= 1
    if below == len(points):
        return None
    fine = points[below]
    if not below:
        return fine["fastest"], "coarsest mesh"
    coarse = points[below - 1]
    x0, x1, y0, y1 = (math.log(v) for v in (coarse["error"], fine["error"], coarse["fastest"], fine["fastest"]))
    return math.exp(y0 + (y1 - y0) * (math.log(at) - x0) / (x1 - x0)), f"n = {coarse['n']} to {fine['n']}"


def series(points, problem):
    """Points of a problem by configuration, in the order in which they were run."""
    found = {}
    for p in points:
        if p["problem"] == problem:
            found.setdefault(p["config"], []).append(p)
    return found


def draw(points, problems, configs, about, path):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    figure, panels = plt.subplots(1, len(problems), figsize=(5.2 * len(problems), 6.4), squeeze=False)
    look = {c.name: (c.colour, c.style, "o") for c in configs} | PEERS
    shown = {}
    for axes, problem in zip(panels[0], problems):
        for name, line in series(points, problem.name).items():
            colour, style, mark = look[name]
            line = sorted(line, key=lambda p: p["n"])
            default = name == DEFAULT
            shown[name], = axes.loglog([100 * p["error"] for p in line], [p["fastest"] for p in line], color=colour, linestyle=style,
                                       marker=mark, markersize=6 if name in PEERS else 4, linewidth=2.6 if default else 1.2,
                                       label=name, zorder=3 if default else 2)
        axes.axvline(100 * AT, color="0.7", linewidth=1, zorder=1)
        axes.set(title=problem.title, xlabel="error, %", ylabel="run time of all steps, s")
        axes.invert_xaxis()
        axes.grid(True, which="both", alpha=0.25)
    figure.suptitle(f"cdem {about['version']} ({about['git']}), {about['device']}: lower and to the right is better")
    figure.legend(shown.values(), shown.keys(), loc="lower center", ncol=4, fontsize=8)
    figure.tight_layout(rect=(0, 0.04 + 0.026 * math.ceil(len(shown) / 4), 1, 0.98))
    figure.savefig(path, dpi=100)
    plt.close(figure)


def table(points, problem):
    rows = ["| configuration | n | elements | steps | error | solve, fastest | median | runs | spread | total | |", "|" + "---|" * 11]
    for name, line in series(points, problem.name).items():
        for p in sorted(line, key=lambda p: p["n"]):
            scaled = f"scaled from {p['scaled_from']} steps; error of the assembled stiffness" if p.get("scaled_from") else ""
            rows.append(f"| {name} | {p['n']} | {p['elements']:,} | {p['steps']:,} | {100 * p['error']:.3g} % | {report.seconds(p['fastest'])} | "
                        f"{report.seconds(p['solve'])} | {len(p['runs'])} | {report.percent(p['spread'])} | {report.seconds(p['total'])} | {scaled} |")
    return rows


def equal_error(points, problems):
    """Run times at equal error (time_at), by problem and configuration."""
    return {p.name: {name: time_at(line) for name, line in series(points, p.name).items()} for p in problems}


def equal_table(points, problems, found):
    rows = ["| configuration | " + " | ".join(p.title for p in problems) + " |", "|---|" + "---|" * len(problems)]
    for name in dict.fromkeys(name for p in problems for name in found[p.name]):
        cells = []
        for p in problems:
            default = found[p.name].get(DEFAULT)
            if name not in found[p.name]:
                cells.append("")
            elif found[p.name][name] is None:
                cells.append(f"not reached ({100 * min(q['error'] for q in series(points, p.name)[name]):.2g} %)")
            else:
                seconds, rests = found[p.name][name]
                cells.append(report.seconds(seconds) + (f", **{seconds / default[0]:.2g}**" if default else "") + f" ({rests})")
        rows.append(f"| {name} | " + " | ".join(cells) + " |")
    return rows


def ratios(found, problems, names):
    """Run time at equal error over that of the default: {problem: {name: ratio or None}}, where the default gets there."""
    return {p: {name: found[p.name][name] and found[p.name][name][0] / found[p.name][DEFAULT][0] for name in names if name in found[p.name]}
            for p in problems if found[p.name].get(DEFAULT)}


def between(values):
    low, high = min(values), max(values)
    return f"{low:.2g} times" if f"{low:.2g}" == f"{high:.2g}" else f"{low:.2g} to {high:.2g} times"


def grouped(said):
    """[(problem, name, text)] as `name (problem text, problem text), name ...`."""
    names = {}
    for problem, name, text in said:
        names.setdefault(name, []).append(problem.short + text)
    return ", ".join(f"{name} ({', '.join(where)})" for name, where in names.items())


def argument(found, problems, configs):
    """What the figures say of the defaults, in words: of every default that has alternatives, then of the peers."""
    text, borne_out, not_borne_out = [], [], []
    for choice in dict.fromkeys(c.choice for c in configs if c.choice):
        table = ratios(found, problems, [c.name for c in configs if c.choice == choice])
        said = [(p, name, r) for p, row in table.items() for name, r in row.items()]
        if not said:
            continue
        never = [(p, name, "") for p, name, r in said if r is None]
        dearer = [r for p, name, r in said if r and r > 1 / NOISE]
        alike = [(p, name, "") for p, name, r in said if r and NOISE <= r <= 1 / NOISE]
        cheaper = [(p, name, f" {r:.2g}") for p, name, r in said if r and r < NOISE]
        say = [f"cheaper than the default: {grouped(cheaper)}" if cheaper else "no alternative is cheaper than the default"]
        say += [f"about as dear: {grouped(alike)}"] if alike else []
        say += [f"{'the others need' if cheaper or alike else 'they need'} {between(dearer)} its run time"] if dearer else []
        say += [f"no mesh here gets there with {grouped(never)}"] if never else []
        (not_borne_out if cheaper else borne_out).append(choice)
        text.append(f"- **{first_upper(choice)}**: {'; '.join(say)}.")
    peers = ratios(found, problems, PEERS)
    for name in PEERS:
        here = {p: row[name] for p, row in peers.items() if row.get(name)}
        if here:
            behind = [p.short for p, r in here.items() if r < 1]
            text.append(f"- **Peer: {name}**: needs " + ", ".join(f"{r:.2g} times ({p.short})" for p, r in here.items())
                        + " the run time of the default, which is " + (f"**behind** it ({', '.join(behind)})." if behind else "ahead of it."))
    if borne_out:
        text.append(f"\nSo the figures bear out the defaults of: {', '.join(borne_out)}."
                    + (f" They do not of: {', '.join(not_borne_out)}; what is cheaper stands above." if not_borne_out else ""))
    return text


def cheapest(found, problems):
    """The cheapest configuration of cdem for every problem."""
    text = []
    for p in problems:
        times = {name: value[0] for name, value in found[p.name].items() if value and name not in PEERS}
        if times:
            best = min(times, key=times.get)
            text.append(f"{best}, {report.seconds(times[best])} ({p.short}; the default "
                        + (f"{report.seconds(times[DEFAULT])})" if DEFAULT in times else "does not get there)"))
    return f"The cheapest of cdem: {'; '.join(text)}." if text else "Nothing here gets there."


def page(about, points, problems, configs, notes, device):
    found = equal_error(points, problems)
    text = [report.title("run time against error", "chart", f"chart_{device}.json"), report.facts(about),
            f"- {about['shared'].capitalize()}; fastest and median of {about['repeat']} turns (fewer of what takes long), all configurations in turn", *(f"- {n}" for n in notes), "",
            f"![Run time against error](chart_{device}.png)", "",
            "Solve: the time of all steps (`wall.solve`; of a peer, its loop). Total: the whole process of cdem and of Akantu; of the assembled",
            "stiffness, assembling by numpy and the loop. Peers take the mesh, the step and the number of steps of the default; at rest they come",
            "with damping by mass, critical for the lowest frequency, which they are told. The direct solution steps through nothing: it answers",
            "a static, linear problem alone.", "", f"## Run time at equal error ({100 * AT:g} %)",
            "On straight lines of the logarithms between two meshes, where all finer ones stay below. Bold: over that of the default. Not reached: the",
            "least error in brackets, of the meshes that ran within the time given to one.", "", *equal_table(points, problems, found), "",
            "## What it says of the defaults", f"Run times at an error of {100 * AT:g} %; what differs by less than {100 * (1 - NOISE):.0f} % counts as alike.",
            cheapest(found, problems), "",
            *argument(found, problems, configs), "", *CAVEATS, ""]
    for problem in problems:
        text += [f"## {first_upper(problem.title)}", " ".join(problem.__doc__.split()), "", *table(points, problem), ""]
    return "\n".join(text)
