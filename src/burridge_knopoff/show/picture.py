"""A picture of a result file: J, section points and velocities of a run, or the figure of a summary."""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
import xarray
from matplotlib.figure import Figure

from burridge_knopoff.figures.description import Description, figure_descriptions
from burridge_knopoff.figures.distance import FLOOR, linear_top
from burridge_knopoff.figures.motion import MOST_NAMED, draw_blocks, draw_section, run_title
from burridge_knopoff.figures.slip_events import draw_run
from burridge_knopoff.figures.style import PAGE, label_panels, new_figure, styled, write_figure
from burridge_knopoff.messages import cut, format_value
from burridge_knopoff.provenance.origin import Origin
from burridge_knopoff.show.result import Result, open_result
from burridge_knopoff.study.keys import condition_refusal
from burridge_knopoff.study.study import Study
from burridge_knopoff.summaries.catalogue import summarize

#: Name of the catalogue file of a run, which is that of the module that makes it.
CATALOGUE_FILE = "slip_events"

FORMATS = (".png", ".pdf", ".svg")

#: Arguments that figures take from the study, for a file that belongs to none.
WITHOUT_STUDY: dict[str, Any] = {"marked_states": {}, "has_paper_chain": False}


def check_format(path: str | Path) -> None:
    """Raise ValueError, one line, unless the suffix of a picture is a known format."""
    if Path(path).suffix not in FORMATS:
        raise ValueError(
            f"{cut(str(path), 200)}: got {format_value(Path(path).suffix)}, expected {' | '.join(FORMATS)}"
        )


def write_picture(result: Result, path: str | Path) -> str:
    """Draw a picture of a result file, and return its description in a line.

    Raises ValueError, one line, if there is no picture of such a file, or if the figure needs another file that is
    missing.
    """
    if result.is_point:
        write_figure(draw_point(result.data), path)
        return f"{path}: J, section points and velocities"
    if result.name == CATALOGUE_FILE:
        law, a = result.data.attrs["law"], result.data["a"].item()
        write_figure(draw_run(summarize([result.data], [law], [a]).isel(law=0, a=0)), path)
        return f"{path}: slips in space and time, their recurrence, rates, extents and intervals"
    if result.is_part:
        summary = f"summary/{result.name}.nc"
        if result.study and summary not in result.files:
            raise ValueError(f"{result.path}: there is no picture of such a file")
        whole = f": {result.study_path(summary)}" if summary in result.files else ""
        raise ValueError(f"{result.path}: no picture of a part of a summary; plot the whole summary{whole}")
    study = _study_of(result)
    figure = _figure_of(result, study)
    inputs = [result if name == result.name else _open_neighbour(result, name) for name in figure.inputs]
    module = import_module(f"burridge_knopoff.figures.{figure.name}")
    caption = figure.caption_of({}, study is not None and study.has_paper_chain)
    try:
        drawn = module.draw(*(source.data for source in inputs), **_study_arguments(study, figure))
    except (AttributeError, KeyError, IndexError, ValueError):
        paths = " with ".join(str(source.path) for source in inputs)
        old = any(not source.of_these_sources for source in inputs)
        reason = "made by other sources" if old else "not the results of one study"
        raise ValueError(f"{paths}: the figure {figure.name} cannot show them: {reason}") from None
    write_figure(drawn, path)
    return f"{path}: {figure.title_of({})}. {caption}"


def _figure_of(result: Result, study: Study | None) -> Description:
    """Return the figure of a summary: the one with its name, otherwise the one that needs the fewest other files."""
    mean = result.data.get("mean_distance")
    # A study of several parameters has figures of its own for the same summaries.
    over = "several" if mean is not None and mean.dims[:2] == ("law", "initial") and mean.ndim > 3 else "a"
    figures = [
        figure
        for figure in figure_descriptions()
        if result.name in figure.inputs
        and figure.over in (over, "any")
        and not (study and condition_refusal(study, figure.condition))
        and (study or set(figure.from_study) <= WITHOUT_STUDY.keys())
    ]
    if not figures:
        raise ValueError(f"{result.path}: there is no picture of such a file")
    return min(figures, key=lambda figure: (figure.name != result.name, len(figure.inputs)))


def _open_neighbour(result: Result, name: str) -> Result:
    """Return another summary that a figure needs, from the same folder."""
    path = result.path.with_name(f"{name}.nc")
    try:
        other = open_result(path)
    except ValueError as error:
        is_listed = f"summary/{name}.nc" in result.files
        reason = f": {error}" if path.exists() or is_listed else ", which is not in the same folder"
        raise ValueError(f"{result.path}: its figure also needs {name}.nc{reason}") from None
    if not _fit(result.data.attrs, other.data.attrs):
        raise ValueError(f"{result.path}: its figure also needs {name}.nc, but {path} is of another study")
    return other


def _fit(first: Mapping[str, Any], second: Mapping[str, Any]) -> bool:
    """Return whether two files can be of one study, by their attributes: not if made from different versions of a file.

    Files that were not made in a study fit.
    """
    first_origin, second_origin = map(_made_from, (first, second))
    return all(first_origin[name] == second_origin[name] for name in first_origin.keys() & second_origin.keys())


def _made_from(attributes: Mapping[str, Any]) -> dict[str, Any]:
    """Return {param, input or the file itself: value or checksum}; empty for a file that was not made in a study."""
    origin = Origin.from_attributes(attributes)
    return {**origin.params, **origin.inputs, origin.file: attributes["checksum"]} if origin else {}


def _study_of(result: Result) -> Study | None:
    """Return the study to which a file belongs."""
    return Study(result.record["config"], result.record["grid"]) if result.study else None


def _study_arguments(study: Study | None, figure: Description) -> dict[str, Any]:
    return {name: getattr(study, name) if study else WITHOUT_STUDY[name] for name in figure.from_study}


@styled
def draw_point(point: xarray.Dataset) -> Figure:
    """Draw J(τ), linear and logarithmic, the return map of W' at upward crossings of the section, and velocities.

    The linear panel cuts off the initial relaxation.
    """
    figure, panels = new_figure(PAGE, 5.2, rows=2, columns=2, share_rows=False, share_columns=False)
    distance, time = point["distance"].values, point["time"].values
    for panel, logarithmic in zip(panels[:2], (False, True), strict=True):
        panel.plot(time, np.maximum(distance, FLOOR) if logarithmic else distance, color="black", linewidth=0.5)
        panel.axvline(point.attrs["transient"], color="0.5", linestyle=":", linewidth=0.8, label="averaging begins")
        panel.set(xlabel=r"$\tau$", ylabel=r"$J(\tau)$")
    panels[0].set_ylim(0.0, linear_top(distance))
    panels[1].set(yscale="log", ylim=(FLOOR, max(10.0, np.nanmax(distance, initial=0.0))))
    panels[1].legend(loc="lower right", handlelength=1.2)
    draw_section(panels[2], point)
    panels[3].set(xlabel=r"$\tau$", ylabel="$U_i$′")
    draw_blocks(panels[3], point, "velocity")
    if panels[3].lines and point.sizes["block"] <= MOST_NAMED:
        figure.legend(*panels[3].get_legend_handles_labels(), ncols=6, loc="outside lower center")
    run = run_title(point)
    titles = (f"{run}: distance of the end blocks", "logarithmic", "section points", "velocities at the end")
    label_panels(panels, titles)
    return figure
