"""The results of the benchmarks as text: a line of the terminal, and a page of Markdown."""
import statistics

BARS = {"solve": lambda v: f"at most {1e3 * v:g} ms", "ns": lambda v: f"at most {v:g} ns",
        "rate": lambda v: f"at least {v / 1e9:g} G/s"}
SHAPES = {"hex8": "hexahedra", "tet4": "tetrahedra", "wedge6": "wedges"}


def seconds(value):
    return f"{value:.4g} s" if value >= 1 else f"{1e3 * value:.4g} ms"


def percent(value):
    return f"{100 * value:.2g} %" if abs(value) < 0.1 else f"{100 * value:.0f} %"


def verdict(case):
    if "bar" not in case:
        return " | "
    kind, value = case["bar"]
    return f"{BARS[kind](value)} | {'reached' if case['reached'] else '**missed**'}"


def elements(summary):
    return ", ".join(f"{n:,} {SHAPES.get(s, s)}" for s, n in summary["elements"].items())


def line(case):
    """One case on the terminal."""
    name = f"{case['name']:18s}"
    if "points" in case:
        return (f"{name}{1e6 * case['a']:.2f} us a step and {1e6 * case['c']:.2f} us a batch: {100 * case['cost']:.4f} % with "
                f"1,000 steps a batch; against 8,000 {100 * case['direct']:+.2f} %  {'' if case['reached'] else 'MISSED'}")
    if "ratio" in case:
        return f"{name}{case['ratio']:.2f} times, spread {percent(case['spread'])}  {'' if case['reached'] else 'MISSED'}"
    if "peak_gib" in case:
        return f"{name}{case['seconds']:.2f} s, {case['peak_gib']:.2f} GiB, spread {percent(case['spread'])}"
    if "forms" in case:
        return "\n".join(f"{name}{f['ns']:.1f} ns, fastest {f['fastest_ns']:.1f} ns, spread {percent(f['spread'])}, "
                         f"{f['fastest_ns'] / case['forms'][-1]['fastest_ns']:.2f} of cdem: {f['form']}"
                         for f in case["forms"]) + "".join(f"\n{name}without: {why}" for why in case.get("missing", []))
    return (f"{name}{seconds(case['solve'])}, spread {percent(case['spread'])}, {case['ns']:.4g} ns, "
            f"{case['rate'] / 1e9:.4g} G element-steps/s  {'' if case.get('reached', True) else 'MISSED'}")


def title(text, command, raw):
    return f"# Benchmarks: {text}\n<!-- Written by tests/benchmarks/{command}; do not edit. Every run is in {raw}. -->\n"


def facts(about):
    """Date, version and machine, as lines of a list."""
    machine = about["cpu"] + f", {about['cores']} cores, {about['memory_gib']} GiB"
    if about["gpu"]:
        machine = f"{about['gpu']['name']} ({about['gpu']['memory']}, driver {about['gpu']['driver']}); {machine}"
    return (f"- Date: {about['date']}\n"
            f"- Version: cdem {about['version']} ({about['git']}), PETSc {about['petsc']}, device {about['device']}\n"
            f"- Machine: {machine}; load at the start {about['load_at_start']:.2f}, at the end {about['load_at_end']:.2f}")


def shared(load):
    """What the load says of other work on the machine while one core was measured."""
    return "other work shared the machine" if load > 1.3 else "the machine had little else to do"


def head(device, about):
    return (title("one GPU" if device == "cuda" else "one CPU core", "run", f"{device}.json") + "\n" + facts(about) + "\n"
            f"- Failed: {', '.join(c['name'] for c in about['failed']) or 'none'}; bars missed: "
            f"{', '.join(c['name'] for c in about['missed']) or 'none'}\n\n")


def scenes(cases, watch_share):
    text = ("Solve: median of the time of all steps. Spread: (slowest - fastest) / median. Rate: element-steps a second"
            + (". CPU share: CPU time over wall time of the worst run that counts" if watch_share else "") + ".\n\n")
    text += "| scene | elements | springs | steps | solve | fastest | runs | spread |" + (" CPU share |" if watch_share else "")
    text += " ns an element-step | rate, G/s | bar | |\n|" + "---|" * (13 if watch_share else 12) + "\n"
    for c in cases:
        s, n = c["summary"], sum(r["used"] for r in c["runs"])
        text += (f"| {c['title']} | {elements(s)} | {s['springs']:,} | {s['steps']:,} | {seconds(c['solve'])} | {seconds(c['fastest'])} | {n} | "
                 f"{percent(c['spread'])} | " + (f"{percent(c['share'])} | " if watch_share else "") +
                 f"{c['ns']:.4g} | {c['rate'] / 1e9:.4g} | {verdict(c)} |\n")
    return text + "\n"


def command(case, about):
    runs = [r for r in case["runs"] if r["used"]]
    walls = [r["wall"] for r in runs]
    return ("## From command to exit\n"
            f"`cdem -options_file options/brick.yaml -output DIR`, start of the program and two frames included: "
            f"**{statistics.median(walls):.2f} s** (median of {len(walls)}, from {min(walls):.2f} to {max(walls):.2f} s). "
            f"A box of one element and one step takes {about['start_wall']:.2f} s: so much of it is MPI, PETSc and the device.\n\n")


def ts(case):
    text = (f"## Cost of TS, way {case['way']}\n"
            "The brick without histories, in batches (`-ts_central_batch`) of several lengths; a turn runs every length.\n"
            "What a batch costs holds all that is done once a batch: TS itself, the event log, the check for unstable\n"
            "motion and, on a GPU, launches, copies and the wait for its end.\n\n"
            "| steps a batch | time a step, us | of the fastest runs, us | spread |\n|---|---|---|---|\n")
    for p in case["points"]:
        text += f"| {p['batch']:,} | {1e6 * p['step']:.3f} | {1e6 * p['fastest']:.3f} | {percent(p['spread'])} |\n"
    low, high = case["direct_range"]
    return text + (f"\nBar: under 1 % with batches of 1,000: {'reached' if case['reached'] else '**missed**'}.\n\n"
                   f"- Fit of a + c / batch to the fastest runs of {sum(r['used'] for r in case['runs'])} turns: "
                   f"a = {1e6 * case['a']:.3f} us a step, c = {1e6 * case['c']:.2f} us a batch: {100 * case['cost']:.4f} %"
                   f"{' (below 0: noise)' if case['c'] < 0 else ''}.\n"
                   f"- 1,000 against 8,000, measured directly: {100 * case['direct']:+.2f} %; in single turns from {100 * low:+.2f} "
                   f"to {100 * high:+.2f} %{': noise' if low < 0 < high else ''}.\n"
                   + (f"- Time a step: the difference of runs of {case['steps']:,} and {2 * case['steps']:,} steps, so that what is "
                      "done once a run is not in it.\n\n" if "steps" in case else
                      "- Time a step: of runs of 8,000 steps; what is done once a run is in it.\n\n"))


def setups(cases):
    text = ("## Set-up\n"
            "One process, critical step included; the most memory of the whole run.\n\n"
            "| from | elements | seconds | fastest | runs | spread | GiB | bars | |\n|---|---|---|---|---|---|---|---|---|\n")
    for c in cases:
        text += (f"| {c['of']} | {elements(c['summary'])} | {c['seconds']:.2f} | {min(used(c, 'setup')):.2f} | {len(used(c, 'setup'))} | "
                 f"{percent(c['spread'])} | {c['peak_gib']:.2f} | {c['bar'][0]} s, {c['bar'][1]} GiB | {'reached' if c['reached'] else '**missed**'} |\n")
    return text + "\n"


def used(case, what):
    return [r[what] for r in case["runs"] if r["used"]]


def ranks(case):
    return ("## Two ranks\n"
            f"{elements(case['summary'])}, general shape, {case['steps']:,} steps: {seconds(case['one'])} on one rank, {seconds(case['two'])} on two: "
            f"**{case['ratio']:.2f} times** (median of {sum(r['used'] for r in case['runs'])} turns, spread {percent(case['spread'])}; "
            f"bar 1.9, {'reached' if case['reached'] else '**missed**'}). Two programs that share nothing, each with half of it, "
            f"are **{case['apart']:.2f} times** as fast as one after the other: what the machine gives.\n\n")


def peers(cases):
    text = ("## Peer\n"
            "The same mesh with its stiffness assembled, one product of matrix and vector a step: the hardest peer for linear\n"
            "elasticity (it gives no stress and cannot break). `-central_way assembled` is such a product by PETSc within cdem;\n"
            "the others (`tests/benchmarks/peer.py`, `peer_torch.py`) assemble by their own code, PyTorch element by element.\n"
            "cdem runs again just before and just after it. Ratio: fastest to fastest. Difference: largest of the displacements\n"
            "at the end from those of cdem, over the largest displacement.\n\n"
            "| scene | program | ns an element-step | fastest | runs | spread | peer / cdem | difference |\n"
            "|---|---|---|---|---|---|---|---|\n")
    for c in cases:
        ours = c["forms"][-1]
        for f in c["forms"]:
            text += (f"| {c['of']} | {f['form']} | {f['ns']:.4g} | {f['fastest_ns']:.4g} | {sum(r['used'] for r in f['runs'])} | "
                     f"{percent(f['spread'])} | "
                     + (" | " if f is ours else f"{f['fastest_ns'] / ours['fastest_ns']:.2f} | " + (f"{f['difference']:.1e}" if "difference" in f else "")) + " |\n")
    for c in cases:
        text += f"\n- {c['of']}: {c.get('version') or 'scipy ' + c['scipy']}" + "".join(f"; without: {why}" for why in c.get("missing", []))
    return text + "\n\n"


def page(device, content):
    """The page of a device."""
    about, cases = content["about"], content["cases"]
    good = [c for c in cases if "failed" not in c]
    about = {**about, "failed": [c for c in cases if "failed" in c], "missed": [c for c in good if not c.get("reached", True)]}
    by_name = {c["name"]: c for c in good}
    rows = [c for c in good if "title" in c]
    text = head(device, about)
    if rows:
        text += scenes(rows, device == "cpu")
    if "brick" in by_name:
        text += command(by_name["brick"], about)
    for case in good:
        if "points" in case:
            text += ts(case)
    if "ranks" in by_name:
        text += ranks(by_name["ranks"])
    if any("peak_gib" in c for c in good):
        text += setups([c for c in good if "peak_gib" in c])
    if any("forms" in c for c in good):
        text += peers([c for c in good if "forms" in c])
    for c in about["failed"]:
        text += f"Failed: {c['name']}\n\n```\n{c['failed']}\n```\n\n"
    return text.rstrip("\n") + "\n"
