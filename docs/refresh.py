"""Update the ledger of claims and the figures of the documentation from finished studies: `make docs`.

The first study is the one that docs/ is printed from. The second is the same study at the depth of `make`.
"""

from __future__ import annotations

import json
import re
import sys
import textwrap
from pathlib import Path

from PIL import Image

from burridge_knopoff.claims.formats import as_json, as_markdown
from burridge_knopoff.provenance.files import write_text

DOCS = Path(__file__).parent
PAGE = DOCS / "claims.md"
LEDGER = DOCS / "claims.json"
DEPTHS = DOCS / "depths.json"
README = DOCS.parent / "README.md"
BEGIN, END = "<!-- made by `make docs` -->", "<!-- end -->"

# Wide enough for a page on a screen, at a third of the bytes of the figures for print.
WIDTH = 1400
COLORS = 96


def page(text: str, content: dict, depths: dict[str, dict]) -> str:
    """Return the text of docs/claims.md with its tables replaced by those of a ledger."""
    before, rest = text.split(BEGIN)
    after = rest.split(END)[1]
    return f"{before}{BEGIN}\n{compared(depths)}\n\n{as_markdown(content, 'figures')}{END}{after}"


def verdicts(content: dict) -> dict:
    """Return the depth of a ledger and its verdicts, by the name of the claim."""
    return {"depth": content["depth"], "verdicts": {claim["name"]: claim["verdict"] for claim in content["claims"]}}


def compared(depths: dict[str, dict]) -> str:
    """Return a sentence that compares the verdicts at the second depth with those at the first."""
    (fine, here), (name, there) = depths.items()
    other = [
        f"{claim}: {verdict}, not {here['verdicts'][claim]}"
        for claim, verdict in there["verdicts"].items()
        if verdict != here["verdicts"][claim]
    ]
    said = f"differ in {len(other)}: {'; '.join(other)}" if other else "are the same"
    text = (
        f"The tables are those of `config/{fine}.yaml`. All {len(there['verdicts'])} verdicts of `config/{name}.yaml` "
        f"({there['depth']}) {said}."
    )
    return textwrap.fill(text, 120, break_on_hyphens=False)


def headline(content: dict) -> str:
    """Return the sentence of the README that counts the independent statements of a ledger."""
    counts, every = content["independent_counts"], sum(content["counts"].values())
    number = sum(counts.values())
    words = {
        "holds": "hold",
        "holds loosely": "hold loosely",
        "depends on convention": "depend on conventions that the paper leaves open",
        "depends on reading": "depend on how they are read",
        "fails": "fail",
        "not testable": "cannot be tested",
    }
    *parts, last = (f"{counts[verdict]} {said}" for verdict, said in words.items() if counts[verdict])
    sentence = (
        f"**Of {number} independent statements, {', '.join(parts)}, and {last}**; {every - number} more repeat these "
        "or follow from them. [docs/claims.md](docs/claims.md) lists all with their numbers."
    )
    return textwrap.fill(sentence, 120, break_on_hyphens=False) + "\n"


def readme(text: str, content: dict) -> str:
    """Return the text of the README with the headline of a ledger."""
    before, rest = text.split(BEGIN)
    return f"{before}{BEGIN}\n{headline(content)}{END}{rest.split(END)[1]}"


def figure_names() -> set[str]:
    """Return the names of the study's figures that the pages of docs/ and the README show or link."""
    pages = [*DOCS.glob("*.md"), DOCS.parent / "README.md"]
    return {name for text in pages for name in re.findall(r"figures/(\w+)\.png", text.read_text(encoding="utf-8"))}


def main(results: Path, default: Path) -> None:
    """Copy the ledger and the figures of a study into docs/, and compare its verdicts with those of another depth."""
    read = [json.loads((study / "summary/claims.json").read_text(encoding="utf-8")) for study in (results, default)]
    content, depths = read[0], {one["study"]: verdicts(one) for one in read}
    write_text(LEDGER, as_json(content))
    write_text(DEPTHS, as_json(depths))
    write_text(PAGE, page(PAGE.read_text(encoding="utf-8"), content, depths))
    write_text(README, readme(README.read_text(encoding="utf-8"), content))
    for name in sorted(figure_names()):
        source = results / f"figures/{name}.png"
        if source.exists():
            picture = Image.open(source).convert("RGB")
            height = round(picture.height * WIDTH / picture.width)
            small = picture.resize((WIDTH, height), Image.Resampling.LANCZOS) if picture.width > WIDTH else picture
            # Median cut, the usual method, would merge the colours of curves, which cover few pixels.
            few = small.quantize(COLORS, method=Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE)
            few.save(DOCS / f"figures/{name}.png", optimize=True)


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
