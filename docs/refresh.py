"""Update the generated parts of the documentation from the study that `make` runs: `make docs`.

Generated are the ledger of claims in docs/verdicts.md, the numbers, the headline and the pictures of the README, the
table of branches of attractors in docs/attractors.md, the table of costs in docs/performance.md, and the figures of
docs/.
"""

from __future__ import annotations

import contextlib
import json
import re
import shutil
import sys
import tempfile
import textwrap
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray
from PIL import Image

from burridge_knopoff.attractors.lookup import branch_names
from burridge_knopoff.claims.comparison import compare
from burridge_knopoff.claims.formats import as_markdown, count_sentence, dependent_sentence
from burridge_knopoff.motion.kind import MotionKind
from burridge_knopoff.provenance.files import write_text
from burridge_knopoff.report.numbers import with_powers_of_ten
from burridge_knopoff.report.stages import read_stages
from burridge_knopoff.study.formatting import span

if TYPE_CHECKING:
    from collections.abc import Mapping

DOCS = Path(__file__).parent
BEGIN, END = "<!-- made by `make docs` -->", "<!-- end -->"

# The table of branches lists those that exist at this many values of a under some law.
LONG = 5

# Decimals of ⟨J⟩ in this table: less is 0.
MEAN_DIGITS = 5

# The table of costs lists rules that take at least this time, in seconds.
LISTED = 10.0

# 200 dots per inch: enough for a screen, at a third of the bytes of the figures for print.
SCALE = 2 / 3
COLORS = 96


def replace_block(text: str, block: str) -> str:
    """Return the text of a page with the generated block between the markers replaced."""
    before, rest = text.split(BEGIN)
    return f"{before}{BEGIN}\n{block}{END}{rest.split(END)[1]}"


def headline(ledger: Mapping[str, Any]) -> str:
    """Return the numbers of the paper and of the study, and how many independent statements have each verdict."""
    sentence = (
        f"**{count_sentence(ledger['independent_counts'])}**; {dependent_sentence(ledger)} "
        "[docs/verdicts.md](docs/verdicts.md) lists all of them with their evidence."
    )
    rows = [
        f"| {words} | {paper} | {with_powers_of_ten(ours)} |" for words, paper, ours, _ in compare(ledger["claims"])
    ]
    table = "\n".join(["| | paper | this software |", "| --- | --- | --- |", *rows])
    return f"{textwrap.fill(sentence, 120, break_on_hyphens=False)}\n\n{table}\n"


def branch_table(attractors: xarray.Dataset) -> str:
    """Return the branches that exist at LONG or more values of a under some law as a table, a row for each law.

    attractors : attractors.nc
    """
    head = "| branch | law | range of a | grid values | ⟨J⟩ | kinds of motion |"
    rows = [head, "| --- | --- | --- | ---: | --- | --- |"]
    names = branch_names(attractors)
    short = 0
    for number, name in sorted(names.items()):
        exists = attractors["branch"] == number
        counts = exists.any("attractor").sum("a")
        if not (counts >= LONG).any():
            short += 1
            continue
        title = name if name.endswith(")") else f"{name} ({number})"
        for law in counts["law"].values[counts.values > 0].tolist():
            part, there = attractors.sel(law=law), exists.sel(law=law).values
            a, mean = part["a"].values[there.any(axis=1)], part["mean_distance"].values[there]
            ends = [round(float(end(mean)), MEAN_DIGITS) for end in (np.nanmin, np.nanmax)]
            kinds = [MotionKind(kind).words for kind in np.unique(part["kind"].values[there]).tolist()]
            cells = [title, law, span(f"{a[0]:g}", f"{a[-1]:g}"), str(len(a)), span(*(f"{end:.2g}" for end in ends))]
            rows.append(f"| {' | '.join([*cells, ', '.join(kinds)])} |")
    return "\n".join(rows) + f"\n\n{short} other branches exist at fewer than {LONG} values of a under each law.\n"


def pages(summary: Path) -> dict[Path, str]:
    """Return the generated block of each page that shows what the summaries of a study say.

    summary : folder of the summaries
    """
    ledger = json.loads((summary / "claims.json").read_text(encoding="utf-8"))
    with xarray.open_dataset(summary / "attractors.nc") as attractors:
        table = branch_table(attractors)
    return {
        DOCS / "verdicts.md": as_markdown(ledger, "figures"),
        DOCS.parent / "README.md": headline(ledger),
        DOCS / "attractors.md": table,
    }


def stage_table(results: Path) -> str:
    """Return the measured cost of the stages of a study that take at least LISTED seconds."""
    stages = read_stages(results / "benchmarks")
    rows = ["| rule | jobs | wall time, s | CPU time, s | memory, MB |", "| --- | ---: | ---: | ---: | ---: |"]
    rows += [
        f"| {stage.name} | {stage.jobs} | {stage.wall:.0f} "
        + (f"| {stage.cpu:.0f} | {stage.memory:.0f} |" if stage.cpu_jobs else "| – | – |")
        for stage in stages
        if stage.wall >= LISTED
    ]
    return "\n".join(rows) + "\n"


def figure_names() -> set[str]:
    """Return the names of the study's figures that the pages of docs/ and the README show or link."""
    texts = [path.read_text(encoding="utf-8") for path in [*DOCS.glob("*.md"), DOCS.parent / "README.md"]]
    return {name for text in texts for name in re.findall(r"figures/(\w+)\.png", text)}


def copy_figure(source: Path) -> None:
    """Write a figure of the study into docs/figures, smaller and with fewer colours."""
    picture = Image.open(source).convert("RGB")
    small = picture.resize([round(size * SCALE) for size in picture.size], Image.Resampling.LANCZOS)
    # Median cut, the usual method, would merge the colours of curves, which cover few pixels.
    few = small.quantize(COLORS, method=Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE)
    few.save(DOCS / "figures" / source.name, optimize=True)


def draw_readme() -> None:
    """Draw the pictures of the README by its first lines of Python."""
    code = re.search(r"```python\n(.*?)```", (DOCS.parent / "README.md").read_text(encoding="utf-8"), re.DOTALL)
    with tempfile.TemporaryDirectory() as folder:
        with contextlib.chdir(folder):
            exec(code[1], {})  # type: ignore[index]
        for picture in Path(folder).glob("*.png"):
            shutil.copy(picture, DOCS / "figures" / f"readme_{picture.name}")


def main(results: Path) -> None:
    """Update the pages and the figures from the results of a study."""
    for path, block in pages(results / "summary").items():
        write_text(path, replace_block(path.read_text(encoding="utf-8"), block))
    performance = DOCS / "performance.md"
    write_text(performance, replace_block(performance.read_text(encoding="utf-8"), stage_table(results)))
    for name in sorted(figure_names()):
        if (source := results / f"figures/{name}.png").exists():
            copy_figure(source)
    draw_readme()


if __name__ == "__main__":
    main(Path(sys.argv[1]))
