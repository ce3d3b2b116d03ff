"""CPU time and memory of one point job, compared with a Python process that only imports what it needs.

`bk simulate` computes a whole grid point and writes its file. Times are user and system time, measured alternately; the
ratio is the median over the rounds. The import is measured as at a prompt, where NumPy starts linear-algebra threads
that are never used, and without them, as in `bk`.
"""

from __future__ import annotations

import argparse
import statistics
import sys
import tempfile

from measure import print_table
from process import AS_TYPED, BIN, IMPORTS, ONE_THREAD, run

LAWS = ("linearized", "nonlinear")


def main() -> None:
    """Measure both laws and print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0], allow_abbrev=False)
    parser.add_argument("--pairs", type=int, default=15, help="rounds (default: %(default)s)")
    pairs = parser.parse_args().pairs
    bk = BIN / "bk"
    imports = [sys.executable, "-c", IMPORTS]
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for law in LAWS:
            job = [str(bk), "simulate", "--law", law, "--a", "0.08", "--initial", "plus", "--out", f"{folder}/tmp.nc"]
            run(imports), run(job)
            used = [(run(job), run(imports, AS_TYPED), run(imports, ONE_THREAD)) for _ in range(pairs)]
            ratio = statistics.median(point.cpu / typed.cpu for point, typed, _ in used)
            single = statistics.median(point.cpu / bare.cpu for point, _, bare in used)
            memory = max(point.memory for point, _, _ in used)
            rows.append(
                [
                    f"{ratio:.2f}",
                    f"{single:.2f}",
                    f"{memory:.0f}",
                    law,
                    *(f"{1e3 * statistics.median(run[i].cpu for run in used):.0f}" for i in range(3)),
                    f"{max(typed.memory for _, typed, _ in used):.0f}",
                ]
            )
    print(f"\n`bk simulate --a 0.08 --initial plus` against `python -c '{IMPORTS}'`, {pairs} rounds.\n")
    header = ["ratio", "ratio, one thread", "peak MB", "law"]
    header += ["job ms", "imports ms", "imports ms, one thread", "imports MB"]
    print_table(header, rows)


if __name__ == "__main__":
    main()
