"""The kernel against that of an earlier commit: single runs, labels of many states, laws by formula, other chains.

    python benchmarks/kernel.py

The earlier kernel is built beside, in a temporary folder. Both are measured in turn, each in a process of its own; a
ratio is that of the least CPU times.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent))

from measure import print_table

REPOSITORY = Path(__file__).resolve().parent.parent
EARLIER = "8341d47"
RUNS = (("minus", 0.08), ("plus", 0.08), ("plus", 0.25))
LAWS = ("linearized", "nonlinear")
LABELS = tuple((law, blocks, a) for law in LAWS for blocks in (3, 8) for a in (0.08, 0.2))
STATES, END, RADIUS, RETURNS = 400, 150.0, 0.01, 8


def least(call: Callable[[], object], repeats: int = 3) -> float:
    """Return the least CPU time of a call, in ms."""
    times = []
    for _ in range(repeats):
        begin = time.process_time()
        call()
        times.append(time.process_time() - begin)
    return 1e3 * min(times)


def starts(blocks: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the states that are labelled, relative to uniform sliding, and that of a cloud that some come close to."""
    generator = np.random.default_rng(1)
    position = generator.uniform(-0.6, 1.5, (STATES, blocks))
    return position, generator.uniform(0.0, 0.2, (STATES, blocks)), generator.uniform(-0.4, 0.4, (300, 2 * blocks))


def earlier() -> dict[str, float]:
    """Measure the kernel of the earlier commit, with the interface that it had."""
    from burridge_knopoff.initial import PAPER_STATES
    from burridge_knopoff.kernel.proximity import Proximity
    from burridge_knopoff.stability.flow import Model, begin, new_solver

    from burridge_knopoff import Chain, Friction, simulate

    found = {}
    for law in LAWS:
        for initial, a in RUNS:
            model = Model(Chain(3), Friction(law, a))
            solver, start = new_solver(model), begin(model, PAPER_STATES[initial])
            solver.end = 1e4

            def bare(solver=solver, start=start):
                solver.begin(start.position, start.velocity, start.stuck)
                while solver.run() == -1:
                    pass

            name = f"{law}, {initial}, a = {a:g}"
            found[f"{name}, bare"] = least(bare)
            for count in (0, 3):
                found[f"{name}, {count} exponents"] = least(
                    lambda law=law, a=a, initial=initial, count=count: simulate(
                        law, a, initial, lyapunov_exponents=count
                    )
                )
    for law, blocks, a in LABELS:
        position, velocity, cloud = starts(blocks)
        solver = new_solver(Model(Chain(blocks), Friction(law, a)))
        solver.halting_block, solver.end = 0, END
        kernel = Proximity(solver, [cloud], [RADIUS], [RETURNS])
        tables = np.zeros((STATES, blocks), dtype=np.intc), np.zeros(STATES, dtype=np.intc), np.zeros(STATES)
        found[f"labels, {law}, N = {blocks}, a = {a:g}"] = least(
            lambda k=kernel, x=position, w=velocity, t=tables: k.label(x, w, *t)
        )
    return found


def now() -> dict[str, float]:
    """Measure the kernel of this tree under the same names, and what the earlier one could not do."""
    from burridge_knopoff import Chain, FormulaLaw, Model, Settings, law_of, simulate
    from burridge_knopoff.kernel._core import Clouds
    from burridge_knopoff.laws import LAWS as BUILT_IN
    from burridge_knopoff.model.initial import PAPER_STATES
    from burridge_knopoff.running.ensemble import new_ensemble
    from burridge_knopoff.running.runner import Runner

    def bare(model: Model, initial: str) -> float:
        solver, start = Runner(model), model.begin(PAPER_STATES[initial])

        def run() -> None:
            solver.begin(start)
            solver.run(1e4)

        return least(run)

    found = {}
    for law in LAWS:
        for initial, a in RUNS:
            model = Model(Chain(3), law_of(law, a))
            name = f"{law}, {initial}, a = {a:g}"
            found[f"{name}, bare"] = bare(model, initial)
            for solver in ("series", "map") if law == "linearized" else ("series",):
                for count in (0, 3):
                    settings = Settings(solver=solver, lyapunov_exponents=count)
                    by = " by map" if solver == "map" else ""
                    found[f"{name}, {count} exponents{by}"] = least(
                        lambda model=model, initial=initial, settings=settings: simulate(model, initial, settings)
                    )
    for law, blocks, a in LABELS:
        position, velocity, cloud = starts(blocks)
        kernel, clouds = new_ensemble(Model(Chain(blocks), law_of(law, a))), Clouds([cloud], 2 * blocks, [RADIUS])
        found[f"labels, {law}, N = {blocks}, a = {a:g}"] = least(
            lambda k=kernel, c=clouds, x=position, w=velocity: k.label(
                x, w, np.zeros(x.shape, bool), c, [RETURNS], [0], END
            )
        )
    for name, kind in BUILT_IN.items():
        law = kind(0.08)
        for chosen, label in ((law, "built in"), (FormulaLaw(0.08, law.formula, **law.numbers), "by formula")):
            found[f"{name} {label}"] = bare(Model(Chain(3), chosen), "plus")
    unequal = Chain(3, coupling=[1.0, 1.1], threshold=[1.0, 1.05, 1.0])
    found["nonlinear, unequal springs and thresholds"] = bare(Model(unequal, law_of("nonlinear", 0.08)), "plus")
    return found


def child(which: str, source: Path) -> dict[str, float]:
    """Measure in a process of its own, with the package from a folder."""
    environment = {**os.environ, "PYTHONPATH": str(source), "OPENBLAS_NUM_THREADS": "1"}
    command = [sys.executable, __file__, "--child", which]
    return dict(json.loads(subprocess.run(command, env=environment, check=True, capture_output=True, text=True).stdout))


def main() -> None:
    """Build the earlier kernel, measure both in turn, and print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0], allow_abbrev=False)
    parser.add_argument("--commit", default=EARLIER, help="the earlier one (default: %(default)s)")
    parser.add_argument("--turns", type=int, default=3, help="turns (default: %(default)s)")
    parser.add_argument("--child", choices=("earlier", "now"), help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.child:
        print(json.dumps({"earlier": earlier, "now": now}[options.child]()))
        return
    with tempfile.TemporaryDirectory() as folder:
        archive = subprocess.run(["git", "archive", options.commit], cwd=REPOSITORY, check=True, capture_output=True)
        subprocess.run(["tar", "-x", "-C", folder], input=archive.stdout, check=True)
        build = [sys.executable, "setup.py", "-q", "build_ext", "--inplace"]
        subprocess.run(build, cwd=folder, check=True, capture_output=True)
        turns = [
            (child("earlier", Path(folder, "src")), child("now", REPOSITORY / "src")) for _ in range(options.turns)
        ]
    before, after = ({name: min(turn[k][name] for turn in turns) for name in turns[0][k]} for k in (0, 1))
    rows = []
    for name, value in after.items():
        old = before.get(name.removesuffix(" by map"))
        rows.append(
            [name, "" if old is None else f"{old:.1f}", f"{value:.1f}", "" if old is None else f"{old / value:.1f}"]
        )
    print_table(["", f"{options.commit}, ms", "now, ms", "ratio"], rows)


if __name__ == "__main__":
    main()
