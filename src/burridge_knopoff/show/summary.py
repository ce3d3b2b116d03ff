"""A page of text about a summary."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from importlib import import_module

import numpy as np
import xarray

from burridge_knopoff.provenance.sources import files_of
from burridge_knopoff.show.attractors import attractor_table, branches
from burridge_knopoff.show.formatting import describe_values, quoted_history, wrap_lines
from burridge_knopoff.show.result import Result
from burridge_knopoff.summaries.text_table import UNLIMITED, table

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


#: Results whose law is an attribute and whose variables do not depend on it.
WITH_LAW_ATTRIBUTE = ("bifurcations", "basins", "slip_events")


def summary_lines(result: Result, width: int = UNLIMITED) -> list[str]:
    """Return a description of a summary in lines of at most a width.

    It has the question that the summary answers, its dimensions, its digest if there is one, and its variables.
    """
    data = result.data
    lines = wrap_lines([f"{result.path}: {data.attrs.get('title', result.name)}", *_question(result)], width)
    lines += ["", "dimensions", *table((), [(f"  {name}", text) for name, text in _dimensions(data)], width), ""]
    if text := digest(result, width):
        lines += [*text, ""]
    lines += ["variables", *table((), [_described(data[name]) for name in data.data_vars], width), ""]
    if settings := [(f"  {key}", _text(value)) for key, value in data.attrs.items() if key not in _ELSEWHERE]:
        lines += ["settings", *table((), settings, width), ""]
    # The history may be a command, which is not wrapped, so that it can be copied.
    return [
        *lines,
        *wrap_lines([f"made by {result.origin}"], width),
        f"history: {quoted_history(str(data.attrs.get('history', 'unknown')))}",
    ]


def _described(variable: xarray.DataArray) -> tuple[str, str, str]:
    over = f" ({', '.join(map(str, variable.dims))})" if variable.dims else ""
    comment = f"; {variable.attrs['comment']}" if "comment" in variable.attrs else ""
    return f"  {variable.name}", describe_values(variable), f"{variable.attrs.get('long_name', '')}{over}{comment}"


def digest(result: Result, width: int = UNLIMITED) -> list[str]:
    """Return lines of at most a width with the main result of a summary; none if there is no digest of this file."""
    data = result.data
    if "law" in data.attrs and "law" not in data.dims and result.name not in WITH_LAW_ATTRIBUTE:
        data = data.expand_dims(law=[data.attrs["law"]])
    try:
        if result.name == "attractors":
            is_single = data.sizes["a"] == data.sizes["law"] == 1 and "branch_name" in data
            return attractor_table(data, {}, width) if is_single else branches(data, width)
        # No other name in a file is imported.
        module = import_module(next(name for name in _modules(result) if files_of(name)))
        return wrap_lines(module.digest(data).rstrip().splitlines(), width)
    except (ImportError, AttributeError, KeyError, ValueError, IndexError, StopIteration):
        # Made by other sources, or only a part of the summary.
        return []


def _modules(result: Result) -> tuple[str, str]:
    """Return names of modules, of which the first that exists makes a summary."""
    return f"burridge_knopoff.summaries.{result.name}", result.data.attrs["source_module"]


def _question(result: Result) -> Iterator[str]:
    """Yield the first paragraph of the docstring of the module that makes a summary."""
    for path, *_ in filter(None, map(files_of, _modules(result))):
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
