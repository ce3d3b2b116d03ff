"""Write the tables of docs/data.md from the files of small studies that have every stage: python docs/dictionary.py.

Each table lists the variables of a file in the order of `ncdump`, with the descriptions in the file itself. The first
line of a table has the dimensions of most of its variables. A variable that an earlier table describes in the same
words is not described again.
"""

from __future__ import annotations

import re
import sys
import tempfile
import textwrap
from collections import Counter
from dataclasses import dataclass, replace
from pathlib import Path

import netCDF4
import numpy as np

from burridge_knopoff.provenance.files import write_text

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs" / "data.md"
# A table: the file that it describes, in the folder of a study.
TABLE = re.compile(r"(?P<begin><!-- variables of (?P<file>\S+) -->\n).*?(?P<end><!-- end -->)", re.DOTALL)

# Coordinates that the page explains once.
COMMON = ("law", "initial", "a", "block", "part")

# Meanings of variables that are named in the row of the variable to which they belong.
UNCERTAINTY = re.compile(r"((its|their) )?standard error|error of|(lower|upper) end")

# The page says once which values stand for unknown numbers.
UNKNOWN = re.compile(r"[,;] ((NaN|-1) (if|for|where|beyond) [^,;]*|otherwise NaN)$")

# Meanings of a flag that answers a question.
ANSWERS = {"undetermined", "unknown", "none", "no", "yes"}

#: Symbols of the paper, which files spell in ASCII.
SYMBOLS = {
    r"<J>": "⟨J⟩",
    r"<": "&lt;",
    r"\bv\*tau\b": "vτ",
    r"\btau\b": "τ",
    r"\bPhi\b": "Φ",
    r"\balpha\b": "α",
    r"\bmu\b": "μ",
    r"\|": r"\\|",
}

#: Short settings of the optional stages of the study that has all of them.
EVERY_STAGE = {
    "catalogue": {"a": [0.2], "profiles": True},
    "edges": {"a": [0.05], "duration": 800, "samples": 20},
    "chains": {
        "blocks": [4],
        "a": [0.05],
        "samples": 2,
        "symmetric_samples": 1,
        "time_limit": 2000,
        "two_blocks": {"a": [0.05, 0.2], "samples": 2},
    },
}


@dataclass(frozen=True)
class Row:
    """A variable, with its errors and the ends of its intervals: names, dimensions, meaning."""

    names: tuple[str, ...]
    dimensions: tuple[str, ...]
    meaning: str

    @property
    def listed(self) -> str:
        """The names as text."""
        return ", ".join(f"`{name}`" for name in self.names)

    def line(self, usual: tuple[str, ...]) -> str:
        """Return the row of a table; its dimensions are given unless they are the usual ones of the table."""
        shape = ""
        if self.dimensions != usual:
            further = self.dimensions[len(usual) :] if usual == self.dimensions[: len(usual)] else ()
            shape = f" ({', '.join(('…', *further) if usual and further else self.dimensions) or 'scalar'})"
        return f"| {self.listed}{shape} | {self.meaning} |"


def rows(path: Path) -> list[Row]:
    """Return the variables of a file, except the coordinates that the page explains once."""
    table: list[Row] = []
    with netCDF4.Dataset(path) as dataset:
        for variable in dataset.variables.values():
            row = _row(variable)
            base = re.sub(r"_(error|low|high)$", "", variable.name)
            owners = [k for k, entry in enumerate(table) if f"{entry.names[0]}_".startswith(f"{base}_")]
            owners = [k for k in owners if not UNCERTAINTY.match(table[k].meaning)]
            if base != variable.name and owners and UNCERTAINTY.match(row.meaning):
                table[owners[0]] = replace(table[owners[0]], names=table[owners[0]].names + row.names)
            elif row.names != row.dimensions or row.names[0] not in COMMON:
                table.append(row)
    return table


def _row(variable: netCDF4.Variable) -> Row:
    text = UNKNOWN.sub(
        "", ": ".join([variable.long_name, *([variable.comment] if "comment" in variable.ncattrs() else [])])
    )
    if "flag_meanings" in variable.ncattrs():
        meanings = dict(zip(np.atleast_1d(variable.flag_values).tolist(), variable.flag_meanings.split(), strict=True))
        # The page explains answers and kinds of motion once.
        if not {*meanings.values()} <= ANSWERS and "quasiperiodic" not in meanings.values():
            text += f": {', '.join(f'{value} {meaning}' for value, meaning in meanings.items())}".replace("-", "−")
    for ascii_text, symbol in SYMBOLS.items():
        text = re.sub(ascii_text, symbol, text)
    # The letters of a text are a dimension that readers do not see.
    dimensions = tuple(name for name in variable.dimensions if not re.fullmatch(r"string\d+", name))
    return Row((variable.name,), dimensions, text)


def page(text: str, folder: Path) -> str:
    """Return the text of docs/data.md with its tables made from the files in the folder of a study."""
    seen: set[tuple[str, str]] = set()

    def is_described(row: Row) -> bool:
        return any(name == row.names[0] and meaning.startswith(row.meaning) for name, meaning in seen)

    def table(match: re.Match[str]) -> str:
        file_rows = rows(sorted(folder.glob(match["file"]))[0])
        new = [row for row in file_rows if not is_described(row)]
        again = ", ".join(row.listed for row in file_rows if row not in new)
        seen.update((row.names[0], row.meaning) for row in file_rows)
        [(usual, _)] = Counter(row.dimensions for row in new).most_common(1)
        lines = [f"| variable ({', '.join(usual) or 'scalar'}) | meaning |", "| --- | --- |"]
        lines += [row.line(usual) for row in new]
        if again:
            lines += ["", textwrap.fill(f"Described above: {again}.", 120)]
        return match["begin"] + "\n".join(lines) + "\n" + match["end"]

    return TABLE.sub(table, text)


def main() -> None:
    """Run the small studies and write the tables."""
    sys.path.insert(0, str(ROOT))
    from tests.small_study import SMALL, run_study

    with tempfile.TemporaryDirectory() as folder:
        results = Path(folder, "results", SMALL["study"])
        run_study(results, {**SMALL, **EVERY_STAGE}, ("summary", "chains"))
        write_text(PAGE, page(PAGE.read_text(encoding="utf-8"), results))


if __name__ == "__main__":
    main()
