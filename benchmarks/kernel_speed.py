"""Speed of this tree's kernel compared with that of another checkout: single runs, groups, labels of many states, laws.

    python benchmarks/kernel_speed.py ../before           # a checkout in which `make kernel` has been run

Both are measured alternately, each in its own process; ratios are those of the smallest CPU times. To compare other
vector widths compile both with `BURRIDGE_KNOPOFF_LANES=2`, 4 or 8.
"""

import argparse
import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent))

from measure import least, print_table

SOURCE = Path(__file__).resolve().parent.parent / "src"
RUNS = (("minus", 0.08), ("plus", 0.08), ("plus", 0.25))
LAWS = ("linearized", "nonlinear")
LABELS = tuple((law, blocks, a) for law in LAWS for blocks in (3, 8) for a in (0.08, 0.2))
STATES, END, RADIUS, RETURNS = 400, 150.0, 0.01, 8
# A long stiff chain, as of Carlson and Langer.
BLOCKS, SLOW, LONG = 100, 0.01, 2000.0


def starts(blocks: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the states to be labelled, relative to uniform sliding, and that of a cloud that some of them approach."""
    generator = np.random.default_rng(1)
    position = generator.uniform(-0.6, 1.5, (STATES, blocks))
    return position, generator.uniform(0.0, 0.2, (STATES, blocks)), generator.uniform(-0.4, 0.4, (300, 2 * blocks))


def measured() -> dict[str, float]:
    """Return {run: smallest CPU time in ms}."""
    from burridge_knopoff import Chain, ChainState, FormulaLaw, Model, Settings, law_of, simulate
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

    durations = {}
    for law in LAWS:
        for initial, a in RUNS:
            model = Model(law, a=a)
            name = f"{law}, {initial}, a = {a:g}"
            durations[f"{name}, bare"] = bare(model, initial)
            for solver in ("series", "map") if law == "linearized" else ("series",):
                for count in (0, 3):
                    settings = Settings(solver=solver, lyapunov_exponents=count)
                    by = " by map" if solver == "map" else ""
                    durations[f"{name}, {count} exponents{by}"] = least(
                        lambda model=model, initial=initial, settings=settings: simulate(
                            model, initial=initial, settings=settings
                        )
                    )
    for law, blocks, a in LABELS:
        position, velocity, cloud = starts(blocks)
        kernel, clouds = new_ensemble(Model(law, a=a, blocks=blocks)), Clouds([cloud], 2 * blocks, [RADIUS])
        durations[f"labels, {law}, N = {blocks}, a = {a:g}"] = least(
            lambda k=kernel, c=clouds, x=position, w=velocity: k.label(
                x, w, np.zeros(x.shape, bool), c, [RETURNS], [0], [0], END
            )
        )
    for name, kind in BUILT_IN.items():
        law = kind(0.08)
        for chosen, label in ((law, "built in"), (FormulaLaw(law.formula, a=0.08, **law.parameters), "by formula")):
            durations[f"{name} {label}"] = bare(Model(chosen), "plus")
    unequal = Chain(3, coupling=[1.0, 1.1], threshold=[1.0, 1.05, 1.0])
    durations["nonlinear, unequal springs and thresholds"] = bare(Model("nonlinear", a=0.08, chain=unequal), "plus")
    law = law_of("carlson_langer", a=5.0, sigma=0.01)
    chain = Model(law, blocks=BLOCKS, coupling=100.0, pulling=1.0, v=SLOW)
    position = -0.9 + 0.0005 * np.random.default_rng(1).uniform(-1.0, 1.0, BLOCKS) - chain.sliding_offset
    solver, rest = Runner(chain), ChainState(position, np.zeros(BLOCKS), np.ones(BLOCKS, dtype=bool))

    def in_groups() -> None:
        solver.begin(rest)
        solver.run(LONG)

    durations[f"carlson_langer, N = {BLOCKS}, bare, in groups"] = least(in_groups)
    return durations


def child(source: Path) -> dict[str, float]:
    """Measure in a process of its own, with the package from a folder."""
    environment = {**os.environ, "PYTHONPATH": str(source), "OPENBLAS_NUM_THREADS": "1"}
    command = [sys.executable, __file__]
    return dict(json.loads(subprocess.run(command, env=environment, check=True, capture_output=True, text=True).stdout))


def main() -> None:
    """Measure both kernels in turn, and print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0], allow_abbrev=False)
    parser.add_argument("checkout", type=Path, nargs="?", help="the other one; without it this tree alone, as JSON")
    parser.add_argument("--turns", type=int, default=3, help="turns (default: %(default)s)")
    options = parser.parse_args()
    if options.checkout is None:
        print(json.dumps(measured()))
        return
    turns = [(child(options.checkout.resolve() / "src"), child(SOURCE)) for _ in range(options.turns)]
    before, after = ({name: min(turn[k][name] for turn in turns) for name in turns[0][k]} for k in (0, 1))
    rows = [
        [name, f"{before[name]:.2f}", f"{value:.2f}", f"{before[name] / value:.2f}"]
        for name, value in after.items()
        if name in before
    ]
    print_table(["", "before, ms", "now, ms", "ratio"], rows)


if __name__ == "__main__":
    main()
