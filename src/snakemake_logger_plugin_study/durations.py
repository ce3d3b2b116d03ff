"""Durations and sizes that the tree ships, by which a study is estimated that has never run on this machine.

`durations.json` holds for each kind of job seconds and bytes, each as a fixed part and one in proportion to its work
(`work.py`), and the seconds that the calibration took on the machine where they were measured: the ratio to those that
it takes here tells how fast this machine is. `benchmarks/durations.py` makes it anew.
"""

from __future__ import annotations

import json
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

FILE = Path(__file__).with_name("durations.json")
#: Of a kind that nobody has measured: seconds to start a script with its libraries, and bytes of a small file.
UNKNOWN = (1.5, 0.0, 50_000.0, 0.0)
#: Of the calibration: runs, of which the fastest counts, and time units of each: short, to slip between other programs.
RUNS, UNITS = 12, 5000.0


@dataclass(frozen=True)
class Durations:
    """What jobs cost where it was measured.

    calibration : seconds of the calibration there
    costs : {kind: (seconds, seconds a unit of work, bytes, bytes a unit of work)}
    """

    calibration: float
    costs: Mapping[str, tuple[float, float, float, float]]

    def seconds(self, kind: str, work: float) -> float:
        """Return the seconds that a job takes there."""
        fixed, rate, _, _ = self._cost(kind)
        return fixed + rate * work

    def size(self, kind: str, work: float) -> float:
        """Return the bytes of the files that a job makes."""
        _, _, fixed, rate = self._cost(kind)
        return fixed + rate * work

    def _cost(self, kind: str) -> Sequence[float]:
        """Return the cost of a kind; of one that is not known, as of a law of one's own, the highest of its rule."""
        if kind in self.costs:
            return self.costs[kind]
        rule = kind.partition(" ")[0]
        alike = [cost for name, cost in self.costs.items() if name.partition(" ")[0] == rule]
        return max(alike, key=lambda cost: cost[1], default=UNKNOWN)


@cache
def shipped() -> Durations:
    """Return what the tree ships."""
    content = json.loads(FILE.read_text(encoding="utf-8"))
    return Durations(content["calibration"], {kind: tuple(cost) for kind, cost in content["costs"].items()})


def calibrate() -> float:
    """Return the seconds that a fixed simulation takes on this machine now; raises ImportError without a kernel."""
    from burridge_knopoff import simulate

    seconds = []
    for _ in range(RUNS):
        begin = time.perf_counter()
        simulate("linearized", 0.08, "plus", transient=0.001, window=UNITS)
        seconds.append(time.perf_counter() - begin)
    return min(seconds)
