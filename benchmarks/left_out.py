"""Makes random single changes to the modules that no fingerprint covers, and checks that none changes a result.

    make .venv-mutants/ready
    .venv-mutants/bin/python benchmarks/left_out.py               # all 100 changes: about 20 minutes on two cores

A small study is run with each change, in a copy of the tree: either it fails, or its config differs, which its params
record, or every file has the same bytes. `provenance/sources.py` names the modules.
"""

from __future__ import annotations

import argparse
import hashlib
import queue
import random
import shutil
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from mutants import PACKAGE, ROOT, Copy, Mutant, change, changes, spots

#: Modules without a fingerprint whose functions are called while numbers are computed.
MODULES = ("messages.py", "model/fields.py", "model/ranges.py", "provenance/keys.py", "provenance/origin.py")
#: CPU time in seconds that a study may take.
LIMIT = 300.0

STUDY = """
import sys
from pathlib import Path
from tests.small_study import SMALL, run_study
config = {**SMALL, "a": [0.05], "chain": {"damping": 0, "coupling": 1}, "catalogue": {}, "figures": {"a": 0.05}}
config["solvers"], config["chains"]["two_blocks"] = {"a": [0.05], "step": 0.05}, {"a": [0.05], "samples": 2}
run_study(Path(sys.argv[1]), config, ("summary",))
"""


def digests(copy: Copy, results: Path) -> dict[str, str] | None:
    """Return {file: digest} of the small study in a copy of the tree, None if it fails."""
    shutil.rmtree(results, ignore_errors=True)
    if not copy.run(["-c", STUDY, str(results)], LIMIT):
        return None
    paths = (path for path in sorted(results.rglob("*")) if path.suffix in (".nc", ".txt", ".csv", ".json"))
    return {path.relative_to(results).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest() for path in paths}


def main() -> int:
    """Try the changes and print those that change a result; return 1 if there are any."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--modules", nargs="+", default=MODULES)
    chosen = parser.parse_args()
    generator = random.Random(chosen.seed)
    places = sorted(place for name in chosen.modules for place in spots(ROOT / PACKAGE / name))
    generator.shuffle(places)
    drawn = (change(path, generator.choice(changes(path)[position])) for path, position in places)
    mutants = [mutant for mutant in drawn if mutant][: chosen.count]
    with tempfile.TemporaryDirectory(prefix="left_out") as folder:
        copies: queue.SimpleQueue[Copy] = queue.SimpleQueue()
        for number in range(2):
            copies.put(Copy(Path(folder) / f"copy{number}"))
        first = copies.get()
        expected = digests(first, Path(f"{first.folder}-results"))
        copies.put(first)
        if not expected:
            print("the study fails on the sources as they are", file=sys.stderr)
            return 1
        outcomes: list[str] = []

        def attempt(mutant: Mutant) -> None:
            copy = copies.get()
            path = copy.folder / PACKAGE / mutant.file
            text = path.read_text(encoding="utf-8")
            try:
                path.write_text(mutant.text, encoding="utf-8")
                checksums = digests(copy, Path(f"{copy.folder}-results"))
            finally:
                path.write_text(text, encoding="utf-8")
                copies.put(copy)
            same = checksums is not None and {**checksums, "study.json": ""} == {**expected, "study.json": ""}
            config = checksums is not None and checksums["study.json"] != expected["study.json"]
            outcomes.append(
                "fails" if checksums is None else "same" if same else "another config" if config else "CHANGED"
            )
            if outcomes[-1] not in ("fails", "same"):
                print(f"{outcomes[-1]}: {mutant}", flush=True)

        with ThreadPoolExecutor(2) as pool:
            list(pool.map(attempt, mutants))
    print(", ".join(f"{outcomes.count(words)} {words}" for words in ("same", "fails", "another config", "CHANGED")))
    return int("CHANGED" in outcomes)


if __name__ == "__main__":
    sys.exit(main())
