"""What a finished study takes on 1 to 256 cores, reckoned from what its jobs have taken and what each waits for.

A job takes the CPU time that Snakemake has measured. The long jobs of a law share their parts out among their
processes; how long each part took stands in their logs. Jobs begin as soon as there are cores for them, those first on
which the longest way to the end depends. Starting a job costs nothing but its own time.
"""

from __future__ import annotations

import argparse
import heapq
import re
import subprocess
import sys
from collections import defaultdict
from dataclasses import dataclass, field
from pathlib import Path

from measure import print_table

from burridge_knopoff.study.job_costs import read_costs

REPOSITORY = Path(__file__).resolve().parent.parent
CORES = [2**k for k in range(9)]

#: Folders of the benchmark files of rules whose files are not named like the rule.
FOLDERS = {
    "attractors_of_law": "attractors",
    "basin_pairs": "basins",
    "basin_tile": "basins",
    "edges_of_law": "edges",
    "phases_of_law": "phases",
    "watch_chain": "chains",
}
NODE = re.compile(r'^\s*(\d+)\[label = "(\w+)((?:\\n[^"]*)?)"')
ARROW = re.compile(r"^\s*(\d+) -> (\d+)")
PART = re.compile(r"^.+: (\d+), ([\d.]+) s, the longest ([\d.]+) s$")


@dataclass
class Job:
    """A job: CPU seconds of one core, (sum, longest) seconds of what several can share, and the jobs it waits for."""

    name: str
    alone: float = 0.0
    shared: list[tuple[float, float]] = field(default_factory=list)
    inputs: list[int] = field(default_factory=list)

    def time(self, cores: float) -> float:
        """Return the most seconds that the job takes on so many cores: whoever is free takes the next piece."""
        return self.alone + sum(total / cores + longest * (1.0 - 1.0 / cores) for total, longest in self.shared)


def read_jobs(results: Path, graph: str) -> dict[int, Job]:
    """Return the jobs of a study by their numbers in the graph that Snakemake has printed."""
    costs = {cost.path.relative_to(results / "benchmarks"): cost for cost in read_costs(results.rglob("*.tsv"))}
    found: dict[int, Job] = {}
    for line in graph.splitlines():
        if node := NODE.match(line):
            number, rule, rest = node.groups()
            values = [item.split(": ", 1)[1] for item in rest.split("\\n") if item]
            found[int(number)] = job = Job(" ".join([rule, *values]))
            paths = [path for path in costs if _is_of(path, rule, values)]
            if paths:
                job.alone = sum(costs[path].cpu or costs[path].wall for path in paths) / len(paths)
                for path in paths:
                    _share(job, results / "logs" / path.with_suffix(".log"))
        elif arrow := ARROW.match(line):
            found[int(arrow[2])].inputs.append(int(arrow[1]))
    return found


def _is_of(path: Path, rule: str, values: list[str]) -> bool:
    """Tell whether a benchmark file is that of a job; of pairs and tiles of basins the names of files differ."""
    if path.with_suffix("").parts[0] != FOLDERS.get(rule, rule):
        return False
    digits = "".join(path.with_suffix("").parts[1:])
    return len(path.parts) == 1 if not values else all(value in digits for value in values)


def _share(job: Job, log: Path) -> None:
    """Take the parts that processes share from the log of a job."""
    for line in log.read_text(encoding="utf-8").splitlines() if log.is_file() else ():
        if part := PART.match(line):
            total, longest = float(part[2]), float(part[3])
            job.shared.append((total, longest))
            job.alone = max(0.0, job.alone - total)


def followers_of(jobs: dict[int, Job]) -> dict[int, list[int]]:
    """Return for each job those that wait for it."""
    followers = defaultdict(list)
    for number, job in jobs.items():
        for before in job.inputs:
            followers[before].append(number)
    return followers


def critical_path(jobs: dict[int, Job]) -> tuple[dict[int, float], list[int]]:
    """Return for each job the least time from its beginning to the end of the study, and the longest way through."""
    followers = followers_of(jobs)
    left: dict[int, float] = {}

    def to_end(number: int) -> float:
        if number not in left:
            left[number] = jobs[number].time(1e9) + max(map(to_end, followers[number]), default=0.0)
        return left[number]

    way = [max(jobs, key=to_end)]
    while followers[way[-1]]:
        way.append(max(followers[way[-1]], key=to_end))
    return left, way


def duration(jobs: dict[int, Job], left: dict[int, float], cores: int) -> float:
    """Return how long the study takes on so many cores."""
    of_pool = max(1, cores // max(1, sum(job.name.startswith("attractors_of_law") for job in jobs.values())))
    missing = {number: len(job.inputs) for number, job in jobs.items()}
    followers = followers_of(jobs)
    ready = [(-left[number], number) for number in jobs if not missing[number]]
    heapq.heapify(ready)
    running: list[tuple[float, int, int]] = []
    now, free = 0.0, cores
    while ready or running:
        waiting = []
        while ready:
            item = heapq.heappop(ready)
            wide = of_pool if jobs[item[1]].shared else 1
            if wide <= free:
                free -= wide
                heapq.heappush(running, (now + jobs[item[1]].time(wide), item[1], wide))
            else:
                waiting.append(item)
        ready = waiting
        now, number, wide = heapq.heappop(running)
        free += wide
        for other in followers[number]:
            missing[other] -= 1
            if not missing[other]:
                heapq.heappush(ready, (-left[other], other))
        heapq.heapify(ready)
    return now


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0], allow_abbrev=False)
    parser.add_argument("results", type=Path, help="results of a finished study: results/<study>")
    parser.add_argument("--configfile", help="its config (default: that of the Snakefile)")
    options = parser.parse_args()
    snakemake = [str(Path(sys.executable).parent / "snakemake"), "-s", str(REPOSITORY / "Snakefile"), "-c2"]
    command = [
        *snakemake,
        "--forceall",
        "--dag",
        "dot",
        *(["--configfile", options.configfile] if options.configfile else []),
    ]
    graph = subprocess.run(command, capture_output=True, text=True)
    if graph.returncode:
        sys.exit(f"{' '.join(command)} failed:\n{graph.stderr[-4000:]}")
    jobs = read_jobs(options.results, graph.stdout)
    left, way = critical_path(jobs)
    single = duration(jobs, left, 1)
    rows = []
    for cores in CORES:
        taken = duration(jobs, left, cores)
        rows.append([cores, f"{taken:.0f}", f"{single / taken:.1f}"])
    print_table(["cores", "seconds", "times faster than one"], rows)
    long = [number for number in way if jobs[number].time(1e9) >= 0.1]
    print_table(
        ["longest way through", "seconds"], [[jobs[number].name, f"{jobs[number].time(1e9):.1f}"] for number in long]
    )
    print(f"critical path {left[way[0]]:.0f} s, {len(jobs)} jobs, {single:.0f} s of CPU")


if __name__ == "__main__":
    main()
