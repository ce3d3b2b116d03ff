"""The page: collects its content and fills in the template."""

from __future__ import annotations

import base64
import zlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import Any

import jinja2
import xarray
from markupsafe import Markup

from burridge_knopoff.claims.formats import ROUNDING
from burridge_knopoff.dataset.summary import open_summary
from burridge_knopoff.report import overview, tables
from burridge_knopoff.report.charts.embedded import Charts, charts
from burridge_knopoff.report.numbers import embedded_json, format_measured
from burridge_knopoff.report.pictures import read_picture
from burridge_knopoff.report.prose import prose
from burridge_knopoff.report.runs import Commands, embedded_runs, unclear_runs
from burridge_knopoff.report.stages import read_stages
from burridge_knopoff.report.trajectories import embedded_trajectories
from burridge_knopoff.report.verdicts import MEANINGS, SIGNS, Verdicts, read_verdicts
from burridge_knopoff.study.study import Study
from burridge_knopoff.summaries.agreement import digest
from burridge_knopoff.summaries.bifurcation_diagram import NEVER_UPWARD

FOLDER = Path(__file__).parent

#: The scripts of the page, in the order in which they are joined: they share one scope.
SCRIPTS = ("data", "theme", "charts", "blocks", "runs", "pictures", "claims", "address", "start")

#: Figures with a place in another section than that of the further figures.
PLACED = (
    "sketch",
    "mean_distance",
    "bifurcation_diagram",
    "lyapunov",
    "orbits",
    "basins",
    "basin_fractions",
    "agreement",
    "chains",
    "grid_distance",
)


@dataclass(frozen=True)
class Sources:
    """The files behind a report.

    claims : the verdicts, None if the study has none
    summaries, figures : {name: path} of netCDF files and of PNG pictures
    benchmarks : folder of Snakemake's benchmark files, which need not exist
    results : folder of the study, None for a page without moving blocks
    """

    claims: Path | None
    summaries: Mapping[str, Path]
    figures: Mapping[str, Path]
    benchmarks: Path = field(default=Path("benchmarks"))
    results: Path | None = None


def render(study: Study, sources: Sources, arguments: Sequence[str] = ()) -> str:
    """Return the report of a study as one HTML file.

    arguments : arguments of `snakemake` that select the study in the report's commands; none for the default study
    Raises ValueError, one line that names the file, if a source cannot be read.
    """
    verdicts = read_verdicts(sources.claims)
    summaries = {name: open_summary(path) for name, path in sources.summaries.items()}
    # One after another: compressing each takes about 100 MB.
    pictures = {name: read_picture(path, study.has_paper_chain) for name, path in sources.figures.items()}
    if "sketch" in pictures:
        pictures["sketch"] = replace(pictures["sketch"], caption=overview.sketch_caption(study))
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(FOLDER / "templates"),
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
        undefined=jinja2.StrictUndefined,
    )
    environment.filters.update(
        prose=prose,
        convention_words=overview.convention_words,
        explanations=partial(overview.explanations, study=study),
    )
    environment.globals.update(format_measured=format_measured)
    drawn = charts(study, summaries)
    if study.is_plane:
        parts = _content_over_parameters(drawn)
    else:
        trajectories = embedded_trajectories(study, sources.results) if sources.results else None
        parts = _content_over_a(study, summaries, drawn, arguments, verdicts, trajectories)
    return environment.get_template("report.html.jinja").render(
        study=study.name,
        blocks=study.blocks,
        over_a=not study.is_plane,
        opening=overview.opening(study),
        ran=overview.run_settings(study),
        states=overview.initial_states(study),
        verdicts=verdicts,
        config=overview.config_text(study),
        mirror_symmetric=study.is_mirror_symmetric,
        pictures=pictures,
        further=[picture for name, picture in pictures.items() if name not in PLACED],
        origins=overview.origins(summaries),
        software=overview.software(),
        stages=read_stages(sources.benchmarks),
        style=_static("style.css"),
        scripts=Markup("\n").join(_static(f"{name}.js") for name in SCRIPTS),
        charts=drawn.packed,
        plotly=_plotly() if any(drawn.packed.values()) else "",
        **parts,
    )


def _content_over_a(
    study: Study,
    summaries: Mapping[str, xarray.Dataset],
    drawn: Charts,
    arguments: Sequence[str],
    verdicts: Verdicts,
    trajectories: Mapping[str, Any] | None,
) -> dict[str, Any]:
    """Return the content of the page that only a study over a alone has."""
    commands = Commands(study, arguments)
    return {
        "convention": overview.convention(verdicts.setting),
        "has_a": study.has_a,
        "paper_chain": study.has_paper_chain,
        "signs": SIGNS,
        "meanings": MEANINGS,
        "rounding": ROUNDING,
        "never_upward": NEVER_UPWARD,
        "section_words": _section_words(study),
        "legends": drawn.legends,
        "data": _data(commands, summaries, drawn.dark, trajectories),
        "moving": trajectories is not None,
        "laws": list(study.laws),
        "initial": list(study.initial),
        "branches": _summary_content(summaries, "attractors", tables.branch_table, []),
        "attractors": _summary_content(summaries, "attractors", lambda attractors: attractors.attrs),
        "sliding": _summary_content(
            summaries, "attractors", lambda dataset: bool((dataset["sliding_attracts"] == 1).any()), False
        ),
        "proved": "proof" in summaries,
        "transitions": tables.transition_table(summaries["orbits"]),
        "synchrony": _summary_content(summaries, "bifurcations", tables.synchrony_table),
        "maps": _summary_content(summaries, "basins", tables.map_table, []),
        "agreement": digest(summaries["agreement"]).splitlines(),
        "chains": _summary_content(summaries, "chains", tables.chain_table, []),
        "unclear": unclear_runs(commands, summaries["mean_distance"], summaries["agreement"]),
    }


def _content_over_parameters(drawn: Charts) -> dict[str, Any]:
    """Return the content of the page that only a study over several parameters has."""
    return {"data": embedded_json({"dark": drawn.dark})}


def _section_words(study: Study) -> str:
    """Describe W."""
    section = study.settings(study.laws[0]).section
    return f"the co-moving position of block {section.block}" if section.block else "the sum of the co-moving positions"


def _data(
    commands: Commands,
    summaries: Mapping[str, xarray.Dataset],
    dark: Mapping[str, str],
    trajectories: Mapping[str, Any] | None,
) -> Markup:
    """Return the data of the page's scripts as JSON."""
    runs = embedded_runs(commands, *(summaries[name] for name in ("mean_distance", "lyapunov", "agreement")))
    return embedded_json({"runs": runs, "dark": dark, "trajectories": trajectories})


def _summary_content(
    summaries: Mapping[str, xarray.Dataset], name: str, make: Callable[[xarray.Dataset], Any], nothing: Any = None
) -> Any:
    """Return the result of `make` for a summary, or `nothing` if the study does not have the summary."""
    return make(summaries[name]) if name in summaries else nothing


def _static(name: str) -> Markup:
    return Markup((FOLDER / "static" / name).read_text(encoding="utf-8"))


def _plotly() -> str:
    """Return the plotting library as base64 of compressed text: less than half its size."""
    from plotly.offline import get_plotlyjs

    return base64.b64encode(zlib.compress(get_plotlyjs().encode(), 9)).decode()
