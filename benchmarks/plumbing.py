"""Changes each function of the files on which no number depends, and compares the numbers of a small study.

    make .venv-mutants/ready
    .venv-mutants/bin/python benchmarks/plumbing.py      # over an hour on two idle cores

`provenance/sources.py` lists these files (PLUMBING): a change there makes no result outdated. In each function Cosmic
Ray changes one place, drawn at random. The study runs in a copy of the tree with every stage. Either it fails, or all
numbers stay as they are, to the bit; the output lists the changes that moved a number, and the exit status is then 1.
"""

from __future__ import annotations

import argparse
import ast
import json
import queue
import random
import subprocess
import sys
import tempfile
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from mutants import PACKAGE, PYTHON, ROOT, Copy, Mutant, change, changes

#: Prints a checksum of the numbers in each netCDF file below a folder; the environment of the mutants lacks netCDF4.
CHECKSUMS = """
import hashlib, json, sys
from pathlib import Path
import netCDF4
sums = {}
for path in sorted(Path(sys.argv[1]).rglob("*.nc")):
    with netCDF4.Dataset(path) as file:
        file.set_auto_mask(False)
        for name, variable in file.variables.items():
            values = variable[...]
            text = values.tobytes() if values.dtype.kind in "fiub" else repr(values.tolist()).encode()
            sums[f"{path.relative_to(sys.argv[1])} {name}"] = hashlib.sha256(text).hexdigest()
print(json.dumps(sums))
"""
#: A study of a few points with every stage.
STUDY = """
study: small
a: [0.05, 0.2]
initial: {minus: {}, plus: {}}
transient: 100
window: 200
batches: 4
attractors: {samples: 4, fraction_width: 0.4, lifetime: 500, transient: 300, window: 300, time_limit: 2000,
  perturbations: 4}
refine: {resolution: 1}
basins: {a: {linearized: [0.05], nonlinear: []}, pixels: 4, pairs: 10, tiles: 1}
phases: {a: [0.05], amplitude: [0.03, 0.3], phase_difference: [20, 180], inner_share: [0, 0.2], samples: 2}
solvers: {a: [0.2], step: 0.01}
chains: {two_blocks: {a: [0.02, 0.15], samples: 2}}
"""
#: CPU seconds of one process; the whole study takes about as long.
LIMIT = 300.0


def plumbing() -> list[Path]:
    """Return the listed files that the fingerprints of results leave out."""
    code = (
        "from burridge_knopoff.provenance.sources import CHECKSUM, COMPILATION, PACKAGE, PLUMBING\n"
        "for path in sorted(PACKAGE.rglob('*.py')):\n"
        "    name = path.relative_to(PACKAGE).as_posix()\n"
        "    if name.startswith(PLUMBING) and path not in (CHECKSUM, COMPILATION):\n"
        "        print(name)\n"
    )
    output = subprocess.run([PYTHON, "-c", code], check=True, capture_output=True, text=True).stdout
    return [ROOT / PACKAGE / name for name in output.split()]


def mutants_of(path: Path, generator: random.Random) -> list[Mutant]:
    """Return a change in each function of a file that can be changed."""
    functions = [node for node in ast.walk(ast.parse(path.read_text())) if isinstance(node, ast.FunctionDef)]
    mutants = []
    for function in functions:
        edits = [
            edit
            for (line, _), edits in changes(path).items()
            if function.body[0].lineno <= line <= (function.end_lineno or 0)
            for edit in edits
        ]
        generator.shuffle(edits)
        mutant = next(filter(None, (change(path, edit) for edit in edits)), None)
        mutants += [mutant] if mutant else []
    return mutants


def numbers(copy: Copy, mutant: Mutant | None = None) -> dict[str, str] | None:
    """Return the checksums of all numbers of the study under a change; None where a job fails or hangs."""
    path = copy.folder / PACKAGE / mutant.file if mutant else None
    kept = path.read_bytes() if path else b""
    with tempfile.TemporaryDirectory(dir=copy.folder.parent) as folder:
        config = Path(folder) / "small.yaml"
        config.write_text(STUDY)
        arguments = ["-m", "snakemake", "-c1", "-d", folder, "--configfile", str(config)]
        try:
            if path and mutant:
                path.write_text(mutant.text, encoding="utf-8")
            ended = copy.run(arguments, LIMIT)
        finally:
            if path:
                path.write_bytes(kept)
        if not ended:
            return None
        sums = subprocess.run([PYTHON, "-c", CHECKSUMS, folder], check=True, capture_output=True, text=True)
        return json.loads(sums.stdout)


def main() -> int:
    """Try the changes and print the outcome; return 1 if a number moved, or the study fails as it is."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--copies", type=int, default=2, help="changes that are tried at a time")
    chosen = parser.parse_args()
    generator = random.Random(chosen.seed)
    mutants = [mutant for path in plumbing() for mutant in mutants_of(path, generator)]
    with tempfile.TemporaryDirectory(prefix="plumbing") as folder:
        copies: queue.SimpleQueue[Copy] = queue.SimpleQueue()
        for number in range(chosen.copies):
            copies.put(Copy(Path(folder) / f"copy{number}"))
        first = copies.get()
        expected = numbers(first)
        copies.put(first)
        if not expected:
            print("the study fails on the sources as they are", file=sys.stderr)
            return 1
        outcomes: Counter[str] = Counter()

        def attempt(mutant: Mutant) -> None:
            copy = copies.get()
            try:
                sums = numbers(copy, mutant)
            finally:
                copies.put(copy)
            outcome = "failed" if sums is None else "same" if sums == expected else "moved"
            outcomes[outcome] += 1
            if outcome == "moved":
                moved = [name for name in expected if (sums or {}).get(name) != expected[name]]
                print(f"{mutant}\n  moves {len(moved)} variables: {', '.join(moved[:3])}", flush=True)

        with ThreadPoolExecutor(chosen.copies) as pool:
            list(pool.map(attempt, mutants))
    print(f"{len(mutants)} changes: {dict(outcomes)}; {len(expected)} variables compared (seed {chosen.seed})")
    return int(outcomes["moved"] > 0)


if __name__ == "__main__":
    sys.exit(main())
