"""The page: collects its content and fills in the template."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import jinja2
import xarray
from markupsafe import Markup

from burridge_knopoff.dataset.given import Given
from burridge_knopoff.dataset.summary import open_summary
from burridge_knopoff.report import overview, tables
from burridge_knopoff.report.charts.embedded import Charts, charts
from burridge_knopoff.report.numbers import embedded_json
from burridge_knopoff.report.pictures import read_picture
from burridge_knopoff.report.prose import prose
from burridge_knopoff.report.runs import Commands, embedded_runs, unclear_runs
from burridge_knopoff.report.stages import read_stages
from burridge_knopoff.report.verdicts import SIGNS, Verdicts, read_verdicts
from burridge_knopoff.study.formatting import text, with_error
from burridge_knopoff.study.study import Study
from burridge_knopoff.summaries.agreement import digest
from burridge_knopoff.summaries.bifurcation_diagram import NEVER_UPWARD

FOLDER = Path(__file__).parent

#: The scripts of the page, in the order in which they are joined: they share one scope.
SCRIPTS = ("data", "theme", "charts", "runs", "pictures", "start")

#: Figures that stand in a section of their own; all others come together.
PLACED = (
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
    """

    claims: Path | None
    summaries: Mapping[str, Path]
    figures: Mapping[str, Path]
    benchmarks: Path = field(default=Path("benchmarks"))


def make(given: Given, config: Mapping[str, Any], parameters: Mapping[str, Any]) -> str:
    """Return the report of a study: its config and its parameters, as in `Study`."""
    claims, summaries, figures = (given.paths(name) for name in ("claims", "summaries", "figures"))
    sources = Sources(
        next(iter(claims), None),
        {path.stem: path for path in summaries},
        {path.stem: path for path in figures},
        given.results / "benchmarks",
    )
    return render(Study(config, parameters), sources, given.arguments)


def render(study: Study, sources: Sources, arguments: Sequence[str] = ()) -> str:
    """Return the report of a study as one HTML file.

    arguments : arguments of `snakemake` that select the study in the report's commands; none for the default study
    Raises ValueError, one line that names the file, if a source cannot be read.
    """
    verdicts = read_verdicts(sources.claims)
    summaries = {name: open_summary(path) for name, path in sources.summaries.items()}
    # One after the other: compressing each takes about 100 MB.
    pictures = {name: read_picture(path) for name, path in sources.figures.items()}
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(FOLDER / "templates"),
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
        undefined=jinja2.StrictUndefined,
    )
    environment.filters.update(number=text, prose=prose)
    environment.globals.update(with_error=with_error)
    shown = charts(study, summaries)
    over_a = _over_grid(shown) if study.is_plane else _over_a(study, summaries, shown, arguments, verdicts)
    return environment.get_template("report.html.jinja").render(
        study=study.name,
        blocks=study.blocks,
        over_a=not study.is_plane,
        opening=overview.opening(study),
        ran=overview.what_was_run(study),
        states=overview.initial_states(study),
        config=overview.config_text(study),
        mirror_symmetric=study.is_mirror_symmetric,
        pictures=pictures,
        further=[picture for name, picture in pictures.items() if name not in PLACED],
        origins=overview.origins(summaries),
        software=overview.software(),
        stages=read_stages(sources.benchmarks),
        style=_static("style.css"),
        **over_a,
    )


def _over_a(
    study: Study,
    summaries: Mapping[str, xarray.Dataset],
    shown: Charts,
    arguments: Sequence[str],
    verdicts: Verdicts,
) -> dict[str, Any]:
    """Return what only the report of a study over a alone has: what its summaries say."""
    commands = Commands(study, arguments)
    return {
        "setting": verdicts.setting,
        "verdicts": verdicts,
        "signs": SIGNS,
        "never_upward": NEVER_UPWARD,
        "section_words": _section_words(study),
        **_interactive(shown),
        "legends": shown.legends,
        "data": _data(commands, summaries, shown.dark),
        "laws": list(study.laws),
        "initial": list(study.initial),
        "branches": _of(summaries, "attractors", tables.branch_table, []),
        "attractors": _of(summaries, "attractors", lambda attractors: attractors.attrs),
        "sliding": _of(summaries, "attractors", lambda found: bool((found["sliding_attracts"] == 1).any()), False),
        "transitions": tables.transition_table(summaries["orbits"]),
        "maps": _of(summaries, "basins", tables.map_table, []),
        "agreement": digest(summaries["agreement"]).splitlines(),
        "chains": _of(summaries, "chains", tables.chain_table, []),
        "unclear": unclear_runs(commands, summaries["mean_distance"], summaries["agreement"]),
    }


def _over_grid(shown: Charts) -> dict[str, Any]:
    """Return what only the report of a study over several parameters has: maps, if two of them vary."""
    if not shown.packed["grid"]:
        return {"charts": {}}
    return {"data": embedded_json({"dark": shown.dark}), **_interactive(shown)}


def _interactive(shown: Charts) -> dict[str, Any]:
    scripts = Markup("\n").join(_static(f"{name}.js") for name in SCRIPTS)
    return {"charts": shown.packed, "plotly": _plotly(), "scripts": scripts}


def _section_words(study: Study) -> str:
    """Describe W."""
    section = study.settings(study.laws[0]).section
    return f"the co-moving position of block {section.block}" if section.block else "the sum of the co-moving positions"


def _data(commands: Commands, summaries: Mapping[str, xarray.Dataset], dark: Mapping[str, str]) -> Markup:
    """Return what the scripts of the page need as JSON."""
    runs = embedded_runs(commands, *(summaries[name] for name in ("mean_distance", "lyapunov", "agreement")))
    return embedded_json({"runs": runs, "dark": dark})


def _of(
    summaries: Mapping[str, xarray.Dataset], name: str, make: Callable[[xarray.Dataset], Any], nothing: Any = None
) -> Any:
    """Return what `make` makes of a summary, or a substitute if the study does not have it."""
    return make(summaries[name]) if name in summaries else nothing


def _static(name: str) -> Markup:
    return Markup((FOLDER / "static" / name).read_text(encoding="utf-8"))


def _plotly() -> Markup:
    from plotly.offline import get_plotlyjs

    # The sequence may occur in a string of the script; in HTML it would end the element.
    return Markup(get_plotlyjs().replace("</script", "<\\/script"))
