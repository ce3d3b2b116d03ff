"""Draw the rules of the default study as a chart in docs/results.md: `python docs/rules.py`."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

from burridge_knopoff.provenance.files import write_text

PAGE = Path(__file__).parent / "results.md"
CHART = re.compile(r"```mermaid\n.*?```\n", re.DOTALL)
#: Rules of one stage are one box.
STAGES = {"basin_tile": "basins", "basin_pairs": "basins", "simulate_solver": "solvers"}
#: What is not a summary.
ENDS = ("simulate", "figures", "claims", "report")


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


def chart(graph: str) -> str:
    """Return the stages and what they read, with all summaries in one box for figures, claims and report."""
    pairs = arrows(graph)
    summaries = sorted({name for pair in pairs for name in pair} - {*ENDS})
    lines = ["flowchart LR", '  simulate["simulate: points"]']
    lines += ['  subgraph summary["summaries"]', *(f'    {name}["{name}"]' for name in summaries), "  end"]
    lines += [f"  {source} --> {target}" for source, target in sorted(pairs) if target in summaries]
    lines += ['  figures["figures"]', '  claims["claims"]', '  report["report"]']
    lines += ["  summary --> figures", "  summary --> claims"]
    lines += [f"  {source} --> {target}" for source, target in sorted(pairs) if {source, target} < {*ENDS}]
    return "```mermaid\n" + "\n".join(lines) + "\n```\n"


def rule_graph() -> str:
    """Return Snakemake's graph of the rules of the default study."""
    command = [sys.executable, "-m", "snakemake", "--rulegraph", "mermaid-js", "--quiet", "all"]
    return subprocess.run(command, check=True, capture_output=True, text=True, cwd=PAGE.parent.parent).stdout


def main() -> None:
    """Replace the chart of the page."""
    new = chart(rule_graph())
    write_text(PAGE, CHART.sub(lambda _: new, PAGE.read_text(encoding="utf-8")))


if __name__ == "__main__":
    main()
