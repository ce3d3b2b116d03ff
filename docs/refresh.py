"""Update the ledger of claims and the figures of the documentation from finished studies: `make docs`.

The ledger, here and in the README, is that of the first study, which `make` runs. The second is the same study at
a greater depth: the figures are its own, and its verdicts are compared.
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
    """Return the depth of a ledger, and the verdicts and reasons by the name of the claim."""
    claims = {claim["name"]: {key: claim[key] for key in ("verdict", "reason")} for claim in content["claims"]}
    return {"depth": content["depth"], "claims": claims}


def differing(depths: dict[str, dict]) -> dict[str, tuple[str, str]]:
    """Return the claims of which the studies have different verdicts: {name: (verdict of the first, of the last)}."""
    first, last = (study["claims"] for study in depths.values())
    pairs = {name: (claim["verdict"], last[name]["verdict"]) for name, claim in first.items()}
    return {name: pair for name, pair in pairs.items() if len({*pair}) > 1}


def compared(depths: dict[str, dict]) -> str:
    """Return a sentence on the study of the tables, and on the verdicts of one that looks closer."""
    name, *closer = depths
    text = f"The tables are those of `config/{name}.yaml`."
    for other in closer:
        found = differing({name: depths[name], other: depths[other]})
        listed = "; ".join(f"{claim}: {there}, not {here}" for claim, (here, there) in found.items())
        said = f"differ in {len(found)}: {listed}" if found else "are the same"
        text += (
            f" All {len(depths[other]['claims'])} verdicts of `config/{other}.yaml` ({depths[other]['depth']}) {said}."
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


def main(default: Path, *closer: Path) -> None:
    """Write the ledger of a study into docs/ and the README, and copy the figures of the one that looks closest."""
    studies = [json.loads((one / "summary/claims.json").read_text(encoding="utf-8")) for one in (default, *closer)]
    content, depths = studies[0], {one["study"]: verdicts(one) for one in studies}
    results = [default, *closer][-1]
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
