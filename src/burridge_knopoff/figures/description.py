"""Descriptions of the figures, which rules, `snakemake --report` and the report of a study read without drawing.

A module of this folder that assigns CAPTION is a figure. It has a function `draw` and these plain constants:

TITLE, CATEGORY : for a reader; PAPER : figures of the paper that it reproduces, as "Fig. 2"
CAPTION : what is seen; {initial} stands for an initial state
INPUTS : names of the summaries that `draw` takes, in order; or `points` alone, the point files of single runs by state
FROM_STUDY : names of properties of `Study` that it takes as well
OVER : the studies that have it: over `a` alone, the default, over `several` parameters, or over `any`
CONDITION : property of `Study` that decides whether the figure exists
FILE : name of the picture, if it is not that of the module
"""

from __future__ import annotations

import ast
import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path


@dataclass(frozen=True)
class Description:
    """The description of a figure, from its module."""

    name: str
    title: str
    category: str
    caption: str
    inputs: tuple[str, ...]
    from_study: tuple[str, ...] = ()
    over: str = "a"
    condition: str = ""
    paper: str = ""
    file: str = ""

    @property
    def words(self) -> str:
        """What it shows: its title, the paper's figure, and its caption up to the first detail."""
        paper, caption = f" (the paper's {self.paper})" if self.paper else "", " ".join(self.caption.split())
        first = re.split(r"[.:;](?: |$)", re.sub(r"^(?:\(a\)|Top:) ", "", caption))[0]
        return f"{self.title}{paper}. {first[0].upper()}{first[1:]}."

    @property
    def of_points(self) -> bool:
        """Whether it shows single runs rather than summaries."""
        return self.inputs == ("points",)

    def caption_of(self, wildcards: Mapping[str, str], has_paper_chain: bool) -> str:
        """Return the caption of a picture as one paragraph, for the paper's chain with a reference to its figure."""
        paper = f" Compare the paper's {self.paper}." if self.paper and has_paper_chain else ""
        return _fill(f"{' '.join(self.caption.split())}{paper}", wildcards)

    def title_of(self, wildcards: Mapping[str, str]) -> str:
        """Return the title of a picture."""
        return _fill(self.title, wildcards)


def _fill(text: str, wildcards: Mapping[str, str]) -> str:
    return text.replace("{initial}", wildcards.get("initial", ""))


@cache
def figure_descriptions() -> tuple[Description, ...]:
    """Return all figures: those of the paper first, then by name."""
    descriptions = [_description(path) for path in Path(__file__).parent.glob("*.py")]
    figures = [description for description in descriptions if description is not None]
    return tuple(sorted(figures, key=lambda figure: (not figure.paper, figure.paper.lstrip("Figs. "), figure.name)))


def title_and_caption(file: str, has_paper_chain: bool) -> tuple[str, str]:
    """Return title and caption of a picture from its file name.

    Raises ValueError if no figure has that name.
    """
    for figure in figure_descriptions():
        head, wildcard, _ = figure.file.partition("{initial}")
        if file == figure.file or (wildcard and file.startswith(head)):
            wildcards = {"initial": file.removeprefix(head)}
            return figure.title_of(wildcards), figure.caption_of(wildcards, has_paper_chain)
    raise ValueError(f"{file}: no figure of that name")


def _description(path: Path) -> Description | None:
    constants, module = {}, ast.parse(path.read_text(encoding="utf-8"))
    for node in module.body:
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name):
            constants[node.targets[0].id] = node.value
    if "CAPTION" not in constants:
        return None
    names = ("TITLE", "CATEGORY", "CAPTION", "INPUTS", "FROM_STUDY", "OVER", "CONDITION", "PAPER", "FILE")
    fields = {name.lower(): ast.literal_eval(constants[name]) for name in names if name in constants}
    return Description(path.stem, **{"file": path.stem, **fields})
