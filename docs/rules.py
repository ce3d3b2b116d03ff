"""Write what is computed from what in the default study into docs/results.md: `python docs/rules.py`."""

from __future__ import annotations

import re
import subprocess
import sys
from collections import defaultdict
from collections.abc import Iterable
from graphlib import TopologicalSorter
from pathlib import Path

from burridge_knopoff.provenance.files import write_text

PAGE = Path(__file__).parent / "results.md"
BEGIN, END = "<!-- made by `python docs/rules.py` -->\n", "<!-- end -->\n"
TABLE = re.compile(f"{BEGIN}.*?{END}", re.DOTALL)
#: Rules that belong to a stage of another name.
STAGES = {"basin_tile": "basins", "basin_pairs": "basins", "simulate_solver": "solvers", "simulate": "points"}
#: What is computed from all or nearly all summaries.
ENDS = ("claims", "figures", "report")


def stage(rule: str) -> str:
    """Return the stage of a rule."""
    return "figures" if rule.startswith("figure_") else STAGES.get(rule, rule.removesuffix("_of_law"))


def arrows(graph: str) -> set[tuple[str, str]]:
    """Return (from, to) of the stages in a graph of rules, as `snakemake --rulegraph mermaid-js` prints it."""
    rules = dict(re.findall(r"(id\d+)\[(\w+)\]", graph))
    pairs = {
        (stage(rules[source]), stage(rules[target])) for source, target in re.findall(r"(id\d+) --> (id\d+)", graph)
    }
    return {(source, target) for source, target in pairs if source != target and target != "all"}


def table(graph: str) -> str:
    """Return a table of the stages and their sources; those with the same sources share a row, sources come first."""
    pairs = arrows(graph)
    sources = {name: {source for source, target in pairs if target == name} for pair in pairs for name in pair}
    summaries = {*sources} - {*ENDS, "points"}
    rank: dict[str, int] = {}
    for name in TopologicalSorter(sources).static_order():
        rank[name] = max((rank[source] + 1 for source in sources[name]), default=0)
    stages = defaultdict(list)
    for name in sorted({"points"} | summaries, key=lambda name: (rank[name], name)):
        stages[listed(sources[name]) or "the config alone"].append(name)
    rows = [(listed(names), text) for text, names in stages.items()]
    for name in ENDS:
        left_out = listed(summaries - sources[name])
        parts = [listed(sources[name] - summaries), "all summaries" + (f" but {left_out}" if left_out else "")]
        rows.append((listed([name]), ", ".join(filter(None, parts))))
    lines = ["| stage | computed from |", "| --- | --- |", *(f"| {names} | {text} |" for names, text in rows)]
    return BEGIN + "\n".join(lines) + "\n" + END


def listed(names: Iterable[str]) -> str:
    """Return the names of stages as a list in words, points first."""
    return ", ".join(f"`{name}`" for name in sorted(names, key=lambda name: (name != "points", name)))


def rule_graph() -> str:
    """Return Snakemake's graph of the rules of the default study."""
    command = [sys.executable, "-m", "snakemake", "--rulegraph", "mermaid-js", "--quiet", "all"]
    return subprocess.run(command, check=True, capture_output=True, text=True, cwd=PAGE.parent.parent).stdout


def main() -> None:
    """Replace the table of the page."""
    new = table(rule_graph())
    write_text(PAGE, TABLE.sub(lambda _: new, PAGE.read_text(encoding="utf-8")))


if __name__ == "__main__":
    main()
