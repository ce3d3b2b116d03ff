"""A page of text about a summary."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from importlib import import_module

import numpy as np
import xarray

from burridge_knopoff.provenance.sources import PACKAGE
from burridge_knopoff.show.attractors import attractor_table
from burridge_knopoff.show.formatting import paragraph, table, values_in_words
from burridge_knopoff.show.result import Result

#: Global attributes that the page shows elsewhere, or that are the same in all files.
_ELSEWHERE = (
    "Conventions",
    "title",
    "summary",
    "keywords",
    "history",
    "software",
    "source_module",
    "source_fingerprint",
)


def summary_lines(result: Result) -> list[str]:
    """Return a description of a summary: its question, dimensions, numbers, and its digest if it has one."""
    data = result.data
    lines = [f"{result.path}: {data.attrs.get('title', result.name)}", *_question(result.name), ""]
    lines += ["over", *paragraph((f"  {name}", text) for name, text in _dimensions(data)), ""]
    if said := digest(result):
        lines += [*said.rstrip().splitlines(), ""]
    lines += ["holds", *table((), [_described(data[name]) for name in data.data_vars]), ""]
    if told := [(f"  {key}", _text(value)) for key, value in data.attrs.items() if key not in _ELSEWHERE]:
        lines += ["with", *paragraph(told), ""]
    return lines + paragraph([("made by", result.made_by), ("", str(data.attrs.get("history", "")))])


def _described(variable: xarray.DataArray) -> tuple[str, str, str]:
    over = f" ({', '.join(map(str, variable.dims))})" if variable.dims else ""
    return f"  {variable.name}", values_in_words(variable), f"{variable.attrs.get('long_name', '')}{over}"


def digest(result: Result) -> str:
    """Return the sentences that the module of a summary makes of its data; empty if it has none for this file."""
    if result.name == "attractors" and result.data.sizes.get("a") == result.data.sizes.get("law") == 1:
        return "\n".join(attractor_table(result.data, {}))
    try:
        module = import_module(result.data.attrs["source_module"])
        return module.digest(result.data)
    except (ImportError, AttributeError, KeyError, ValueError, IndexError):
        # Made by other sources, or only a part of the summary.
        return ""


def _question(name: str) -> Iterator[str]:
    """Yield the first paragraph of the docstring of a summary's module."""
    path = PACKAGE / "summaries" / f"{name}.py"
    if path.is_file():
        text = ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))) or ""
        yield from text.partition("\n\n")[0].splitlines()


def _dimensions(data: xarray.Dataset) -> Iterator[tuple[str, str]]:
    for name, size in data.sizes.items():
        along = [data[key] for key in data.coords if data[key].dims == (name,)]
        words = [f"{'' if item.name == name else f'{item.name} '}{values_in_words(item)}" for item in along]
        yield str(name), ": ".join([f"{size:4}", *["; ".join(words)] * bool(words and size)])


def _text(value: object) -> str:
    return ", ".join(f"{item:g}" for item in value) if isinstance(value, np.ndarray) else str(value)
