"""A page of text about a summary."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path

import numpy as np
import xarray

from burridge_knopoff.provenance.sources import PACKAGE
from burridge_knopoff.show.attractors import attractor_table
from burridge_knopoff.show.digests import DIGESTS
from burridge_knopoff.show.formatting import UNLIMITED, describe_values, table, wrap_lines
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


def summary_lines(result: Result, width: int = UNLIMITED) -> list[str]:
    """Return a description of a summary in lines of at most a width.

    It has the question that the summary answers, its dimensions, its digest if there is one, and its variables.
    """
    data = result.data
    lines = wrap_lines([f"{result.path}: {data.attrs.get('title', result.name)}", *_question(result)], width)
    lines += ["", "dimensions", *table((), [(f"  {name}", text) for name, text in _dimensions(data)], width), ""]
    if text := digest(result):
        lines += [*wrap_lines(text.rstrip().splitlines(), width), ""]
    lines += ["variables", *table((), [_described(data[name]) for name in data.data_vars], width), ""]
    if settings := [(f"  {key}", _text(value)) for key, value in data.attrs.items() if key not in _ELSEWHERE]:
        lines += ["settings", *table((), settings, width), ""]
    # The history may be a command, which is not wrapped, so that it can be copied.
    return [
        *lines,
        *wrap_lines([f"made by {result.origin}"], width),
        f"history: {data.attrs.get('history', 'unknown')}",
    ]


def _described(variable: xarray.DataArray) -> tuple[str, str, str]:
    over = f" ({', '.join(map(str, variable.dims))})" if variable.dims else ""
    return f"  {variable.name}", describe_values(variable), f"{variable.attrs.get('long_name', '')}{over}"


def digest(result: Result) -> str:
    """Return sentences or a table computed from the data of a summary; empty if there are none for this file."""
    if result.name == "attractors" and result.data.sizes.get("a") == result.data.sizes.get("law") == 1:
        return "\n".join(attractor_table(result.data, {}))
    try:
        if result.name in DIGESTS:
            return DIGESTS[result.name](result.data)
        module = import_module(result.data.attrs["source_module"])
        return module.digest(result.data)
    except (ImportError, AttributeError, KeyError, ValueError, IndexError):
        # Made by other sources, or only a part of the summary.
        return ""


def _question(result: Result) -> Iterator[str]:
    """Yield the first paragraph of the docstring of the module that makes a summary."""
    source = Path(*result.data.attrs["source_module"].split(".")[1:]).with_suffix(".py")
    for path in (PACKAGE / "summaries" / f"{result.name}.py", PACKAGE / source):
        if path.is_file():
            text = ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))) or ""
            yield " ".join(text.partition("\n\n")[0].split())
            break


def _dimensions(data: xarray.Dataset) -> Iterator[tuple[str, str]]:
    for name, size in data.sizes.items():
        along = [data[key] for key in data.coords if data[key].dims == (name,)]
        words = [f"{'' if item.name == name else f'{item.name} '}{describe_values(item)}" for item in along]
        yield str(name), ": ".join([f"{size:4}", *["; ".join(words)] * bool(words and size)])


def _text(value: object) -> str:
    return ", ".join(f"{item:g}" for item in value) if isinstance(value, np.ndarray) else str(value)
