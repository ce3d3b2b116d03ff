"""Makes random single changes to the sources and checks that the tests of their subpackages notice them.

    make mutants                                         # 300 changes: up to two hours on two idle cores
    .venv-mutants/bin/python benchmarks/mutants.py --count 40 --rooms kernel --seed 7

Cosmic Ray makes the changes (an operator, a comparison, a constant, a condition), and mutants_cpp.py those of C++;
mutmut 3 calls its mutants through wrappers of Python functions, which a compiled kernel does not have. Each is tried in
a copy of the tree, where a changed kernel is compiled. The output lists the changes that no test noticed, and the share
of those that were noticed. Changes that change no result are listed in mutants.toml with the reason.
"""

from __future__ import annotations

import argparse
import ast
import os
import queue
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import tomllib
from collections import defaultdict
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import parso
from cosmic_ray.ast import ast_nodes
from cosmic_ray.mutating import mutate_code
from cosmic_ray.plugins import get_operator, operator_names

sys.path.insert(0, str(Path(__file__).resolve().parent))

from mutants_cpp import changes_of_cpp

ROOT = Path(__file__).parents[1]
PACKAGE = Path("src/burridge_knopoff")
PYTHON = ROOT / ".venv/bin/python"
LEFT_OUT = (".git", ".snakemake", "results", "build", "fuzzed", ".venv*", "__pycache__", ".*_cache")
ROOMS = (
    "summaries",
    "continuation",
    "basins",
    "attractors",
    "motion",
    "periodic_orbits",
    "claims",
    "dataset",
    "model",
    "laws",
    "running",
    "kernel",
)

#: Further tests of a change in a subpackage, quick ones first. Comparisons of builds do not test a changed source.
TESTS = {
    "model": ("study", "running", "periodic_orbits", "attractors"),
    "periodic_orbits": ("motion", "continuation", "summaries/test_bifurcations.py"),
    "laws": ("model", "running/test_simulation.py"),
    "dataset": ("library/test_open_study.py",),
    "motion": ("attractors", "study/test_keys.py", "dataset/test_numbers.py"),
    "attractors": ("continuation", "basins"),
    "running": ("dataset", "kernel/test_exponents.py", "study/test_keys.py"),
    "kernel": ("attractors/test_ensemble.py", "laws", "running", "periodic_orbits/test_synchronized.py"),
}
DESELECTED = ("--deselect", "tests/kernel/test_builds.py")

#: Operators that give a number where there was one; every other replacement is a TypeError that any test notices.
ARITHMETIC = ("Add", "Sub", "Mul", "Div")
LEFT_ALONE = ("RemoveDecorator", "ExceptionReplacer", "VariableReplacer", "VariableInserter")

#: Compiles all of the kernel: its C++ is one module.
BUILD = ["setup.py", "--quiet", "build_ext", "--inplace"]


@dataclass(frozen=True)
class Mutant:
    """One change of one file of the package: the whole text, and the line that differs before and after."""

    file: str
    number: int
    before: str
    after: str
    text: str

    def __str__(self) -> str:
        return f"{self.file}:{self.number}\n  - {self.before}\n  + {self.after}"


def sample(rooms: list[str], count: int, seed: int) -> list[Mutant]:
    """Return changes at places drawn at random, of a kind drawn at random, no two at one place."""
    paths = [
        path for room in rooms for path in (ROOT / PACKAGE / room).rglob("*") if path.suffix in (".py", ".cpp", ".h")
    ]
    places = sorted({place for path in paths for place in spots(path)})
    generator = random.Random(seed)
    generator.shuffle(places)
    mutants: list[Mutant] = []
    for path, position in places:
        if len(mutants) == count:
            break
        mutant = change(path, generator.choice(changes(path)[position]))
        if mutant:
            mutants.append(mutant)
    return mutants


def spots(path: Path) -> list[tuple[Path, object]]:
    """Return where a file can be changed."""
    return [(path, position) for position in changes(path)]


#: Wall time allowed per second of CPU time, so that sleeping processes end too.
PATIENCE = 30

#: Address space of a process in KB, several times what the tests need: a change may let a list grow without limit.
MEMORY = 8_000_000

#: {file: {place: functions that return the file with a change there}}.
KNOWN: dict[Path, dict[object, list[Callable[[], str]]]] = {}


def changes(path: Path) -> dict[object, list[Callable[[], str]]]:
    """Return {place: functions that return the file with a change there}."""
    if path not in KNOWN:
        text = path.read_text(encoding="utf-8")
        KNOWN[path] = changes_of_python(text) if path.suffix == ".py" else changes_of_cpp(text)
    return KNOWN[path]


def changes_of_python(text: str) -> dict[object, list[Callable[[], str]]]:
    """Return {(line, column): functions that return Python code with a change there}."""
    edits = defaultdict(list)
    nodes = list(ast_nodes(parso.parse(text)))
    for name in filter(is_used, operator_names()):
        operator = get_operator(name)()
        spans = [span for node in nodes for span in operator.mutation_positions(node)]
        for occurrence, (begin, _) in enumerate(spans):
            edits[begin].append(partial(mutate_code, text, operator, occurrence))
    return edits


def is_used(name: str) -> bool:
    """Return whether an operator of Cosmic Ray is a useful test of the tests."""
    kind, *operators = name.split("/")[1].split("_")
    if kind == "ReplaceBinaryOperator":
        return set(operators) <= set(ARITHMETIC)
    return kind not in LEFT_ALONE


def change(path: Path, make: Callable[[], str]) -> Mutant | None:
    """Return a changed file, or None if it is no longer valid Python or changed in annotations only."""
    original, text = path.read_text(encoding="utf-8"), make()
    try:
        if path.suffix == ".py" and bare(text) == bare(original):
            return None
    except SyntaxError:
        return None
    lines = original.splitlines(), text.splitlines()
    number = next(k for k, pair in enumerate(zip(*lines, strict=False)) if pair[0] != pair[1])
    file = path.relative_to(ROOT / PACKAGE).as_posix()
    return Mutant(file, number + 1, lines[0][number].strip(), " ".join(lines[1][number].split()), text)


def bare(text: str) -> str:
    """Return the syntax tree of a text without annotations."""
    tree = ast.parse(text)
    for node in ast.walk(tree):
        for name in ("annotation", "returns"):
            if isinstance(getattr(node, name, None), ast.AST):
                setattr(node, name, ast.Constant(None))
    return ast.dump(tree)


def tests_of(file: str) -> list[str]:
    """Return the tests of a changed file, those of the file itself first."""
    room, *_, name = file.split("/")
    wanted = [f"{room}/test_{Path(name).stem}.py", room, *TESTS.get(room, ())]
    return [f"tests/{test}" for test in wanted if (ROOT / "tests" / test).exists()]


class Copy:
    """A copy of the tree in which changes are tried."""

    def __init__(self, folder: Path):
        self.folder = folder
        shutil.copytree(ROOT, folder, ignore=shutil.ignore_patterns(*LEFT_OUT))
        self.environment = {
            **os.environ,
            "PYTHONPATH": str(folder / "src"),
            "PYTHONDONTWRITEBYTECODE": "1",
            "OPENBLAS_NUM_THREADS": "1",
        }

    def run(self, command: list[str], limit: float) -> bool:
        """Return whether a command succeeds within a CPU time, which does not depend on the load of the machine."""
        process = subprocess.Popen(
            ["sh", "-c", f'ulimit -v {MEMORY} && ulimit -t "$0" && exec "$@"', f"{limit:.0f}", str(PYTHON), *command],
            cwd=self.folder,
            env=self.environment,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            start_new_session=True,
        )
        try:
            return process.wait(PATIENCE * limit) == 0
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
            return False

    def passes(self, file: str, limit: float) -> bool:
        """Return whether the tests of a file pass; also False if they take too long."""
        folder = self.folder.with_name(self.folder.name + "-pytest")
        options = ["-x", "-n", "0", "-p", "no:cacheprovider", "--basetemp", str(folder), *DESELECTED]
        return self.run(["-m", "pytest", *options, *tests_of(file)], limit)

    def survives(self, mutant: Mutant, limit: float) -> bool:
        """Return whether the tests do not notice a change."""
        path = self.folder / PACKAGE / mutant.file
        compiled = [*path.parent.glob("*.so"), *path.parent.glob("build.json")]
        kept = {item: item.read_bytes() for item in [path, *compiled]}
        try:
            path.write_text(mutant.text, encoding="utf-8")
            if compiled and not self.run(BUILD, limit):
                return False
            return self.passes(mutant.file, limit)
        finally:
            for item, content in kept.items():
                item.write_bytes(content)


def equivalents() -> list[tuple[str, str, str]]:
    """Return the patterns (file, line, changed line) of the changes that change no result."""
    listed = tomllib.loads(Path(__file__).with_suffix(".toml").read_text(encoding="utf-8"))
    return [(item["file"], item["line"], becomes) for item in listed["equivalent"] for becomes in item["becomes"]]


def is_equivalent(mutant: Mutant, listed: list[tuple[str, str, str]]) -> bool:
    """Return whether a change is listed; … in a pattern stands for any text."""
    texts = (mutant.file, mutant.before, mutant.after)
    return any(all(map(matches, item, texts)) for item in listed)


def matches(pattern: str, text: str) -> bool:
    """Return whether a text matches a pattern."""
    return re.fullmatch(".*".join(map(re.escape, pattern.split("…"))), text) is not None


def cpu_of_children() -> float:
    """Return the CPU time of the processes that have ended, in seconds."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def main() -> int:
    """Try the changes and print the outcome; return 1 if the tests fail on the unchanged sources."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=300)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--rooms", nargs="+", default=ROOMS, choices=ROOMS)
    parser.add_argument("--copies", type=int, default=2, help="changes that are tried at a time")
    chosen = parser.parse_args()
    listed = equivalents()
    mutants = sample(chosen.rooms, chosen.count, chosen.seed)
    tried = [item for item in mutants if not is_equivalent(item, listed)]
    with tempfile.TemporaryDirectory(prefix="mutants") as folder:
        copies: queue.SimpleQueue[Copy] = queue.SimpleQueue()
        for number in range(chosen.copies):
            copies.put(Copy(Path(folder) / f"copy{number}"))
        limits = {}
        first = copies.get()
        for room in sorted({item.file.split("/")[0] for item in tried}):
            begin = cpu_of_children()
            if not first.passes(f"{room}/", 3600.0):
                print(f"the tests of {room} fail on the sources as they are", file=sys.stderr)
                return 1
            limits[room] = 60.0 + 5.0 * (cpu_of_children() - begin)
        copies.put(first)
        verdicts: list[bool] = []

        def attempt(mutant: Mutant) -> None:
            copy = copies.get()
            try:
                noticed = not copy.survives(mutant, limits[mutant.file.split("/")[0]])
            finally:
                copies.put(copy)
            verdicts.append(noticed)
            if not noticed:
                print(f"{len(verdicts)} of {len(tried)} tried; not noticed: {mutant}", flush=True)

        with ThreadPoolExecutor(chosen.copies) as pool:
            list(pool.map(attempt, tried))
    print(f"{sum(verdicts)} of {len(tried)} changes noticed, {sum(verdicts) / max(1, len(tried)):.1%};", end=" ")
    print(f"{len(mutants) - len(tried)} more change no result (seed {chosen.seed}, {' '.join(chosen.rooms)})")
    return 0


if __name__ == "__main__":
    sys.exit(main())
