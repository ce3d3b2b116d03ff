"""Write docs/variables.md from the files of small studies that have every stage: python docs/dictionary.py.

Each file has the docstring of the module that makes it, and a table of its variables in the order of `ncdump`, with the
descriptions in the file itself. The first line of a table has the dimensions of most of its variables. A variable that
an earlier table describes in the same words is not described again.
"""

from __future__ import annotations

import ast
import re
import sys
import tempfile
import textwrap
from collections import Counter
from dataclasses import dataclass, replace
from pathlib import Path

import netCDF4
import numpy as np

from burridge_knopoff.motion.kind import MotionKind
from burridge_knopoff.outputs import outputs
from burridge_knopoff.provenance.files import write_text
from burridge_knopoff.provenance.sources import files_of

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs" / "variables.md"
HEAD = """\
# Variables of every file

<!-- made by `python docs/dictionary.py` -->
This page is to be looked up: it lists the variables of every netCDF file of a study, with the descriptions that the
files themselves contain, and the attributes that only some files have. [data.md](data.md) explains the dimensions, the
numbers of flags and the attributes that every file has. [results.md](results.md) says which file answers which
question, [glossary.md](glossary.md) defines the terms. The coordinates `law`, `initial`, `a`, `block` and `part` (of a
complex number) are not repeated.
"""

# Folders of files with variables of their own; those of other folders are parts of summaries.
FOLDERS = ("points", "summary", "returns", "catalogues")

# Coordinates that the page names once.
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


def files() -> list[str]:
    """Return the names of the files with variables of their own, in the order of the workflow."""
    names = [
        name.replace("{run}", "{law}/{initial}/a{a}") for item in outputs().values() for name in item.names.split()
    ]
    return [name for name in names if name.endswith(".nc") and name.partition("/")[0] in FOLDERS]


def docstring(path: Path) -> str:
    """Return the docstring of the module that makes a file."""
    with netCDF4.Dataset(path) as dataset:
        modules = f"burridge_knopoff.summaries.{path.stem}", dataset.source_module
    source = next(found for name in modules for found in files_of(name))
    return ast.get_docstring(ast.parse(source.read_text(encoding="utf-8"))) or ""


def page(folder: Path) -> str:
    """Return the text of the page, made from the files in the folder of a study."""
    paths = {name: sorted(folder.glob(re.sub(r"\{\w+\}", "*", name)))[0] for name in files()}
    attributes = {}
    for name, path in paths.items():
        with netCDF4.Dataset(path) as dataset:
            attributes[name] = dataset.ncattrs()
    common = set.intersection(*(set(names) for name, names in attributes.items() if name.startswith("summary/")))
    kinds = ", ".join(f"{kind.value} {kind.words}".replace("-", "−") for kind in MotionKind)
    parts = [HEAD, textwrap.fill(f"Kinds of motion are {kinds}.", 120)]
    seen: set[tuple[str, str]] = set()
    for name, path in paths.items():
        parts += [f"## `{name.replace('{', '<').replace('}', '>')}`", docstring(path), table(rows(path), seen)]
        if further := [f"`{key}`" for key in attributes[name] if key not in common]:
            parts.append(textwrap.fill(f"Attributes: {', '.join(further)}.", 120))
    return "\n\n".join(part.strip() for part in parts) + "\n"


def table(file_rows: list[Row], seen: set[tuple[str, str]]) -> str:
    """Return the table of the variables of a file without those that were seen in other files, and add these to them.

    seen : names and meanings
    """
    new = [row for row in file_rows if not is_described(row, seen)]
    again = ", ".join(row.listed for row in file_rows if row not in new)
    seen.update((row.names[0], row.meaning) for row in file_rows)
    [(usual, _)] = Counter(row.dimensions for row in new).most_common(1)
    lines = [f"| variable ({', '.join(usual) or 'scalar'}) | meaning |", "| --- | --- |"]
    lines += [row.line(usual) for row in new]
    if again:
        lines += ["", textwrap.fill(f"Described above: {again}.", 120)]
    return "\n".join(lines)


def is_described(row: Row, seen: set[tuple[str, str]]) -> bool:
    """Return whether a variable of this name and meaning was seen."""
    return any(name == row.names[0] and meaning.startswith(row.meaning) for name, meaning in seen)


def main() -> None:
    """Run the small studies and write the page."""
    sys.path.insert(0, str(ROOT))
    from tests.small_study import SMALL, run_study

    with tempfile.TemporaryDirectory() as folder:
        results = Path(folder, "results", SMALL["study"])
        run_study(results, {**SMALL, **EVERY_STAGE}, ("summary", "chains"))
        write_text(PAGE, page(results))


if __name__ == "__main__":
    main()
