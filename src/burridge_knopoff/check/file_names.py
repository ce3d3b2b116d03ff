"""The names of all files that the workflow writes into the results of a study, and of those that it wrote earlier.

The names of points, and of other files of which there may be any number, are patterns; all other names are listed.
"""

from __future__ import annotations

import re

from burridge_knopoff.model.initial import STATE_NAME
from burridge_knopoff.model.model import LAW_NAME
from burridge_knopoff.study.paths import VALUE

_SUMMARIES = """
agreement attractors basins bifurcation_diagram bifurcations catalogue chains edges equilibrium lyapunov mean_distance
orbits phases proof refined rotation runs solvers stick_slip two_blocks
"""
_TEXTS = """
agreement.csv agreement.txt attractors.txt basins.txt bifurcations.txt claims.csv claims.json claims.md edges.txt
proof.txt
"""
_FIGURES = """
agreement attractor_kinds basin_fractions basins bifurcation_diagram bifurcations branches_reached catalogue chains
detuning distance edges equilibrium friction_laws grid_distance grid_exponents grid_kinds lyapunov mean_distance
motion_{initial} orbits phases rotation sketch slip_map solvers stick_slip two_blocks
"""
#: Results of which there is one for each run, chunk, law, map or chain.
_OTHERS = """
points/{run}.nc solvers/{solver}/{run}.nc chunks/{number}.done attractors/{law}.nc refined/{law}.nc returns/{law}.nc
basins/{law}/{a}/tile{number}.nc basins/{law}/{a}/pairs.nc bifurcations/{law}.nc edges/{law}.nc phases/{law}.nc
catalogues/{law}/{a}.nc chains/blocks{number}.nc
"""
#: Jobs that do not have the name of their summary or figure.
_JOBS = """
simulate/{run} simulate_solver/{solver}/{run} chunk/{number} attractors/{law} basins/{law}/{a}/tile{number}
basins/{law}/{a}/pairs bifurcations/{law} edges/{law} phases/{law} catalogues/{law}/{a} chains/blocks{number} claims
report
"""
#: Of earlier versions.
_EARLIER_SUMMARIES, _EARLIER_FIGURES = (
    "bifurcation grid",
    "bifurcation bifurcation_refined bifurcation_diagram_refined windows",
)
_EARLIER_OTHERS, _EARLIER_JOBS = "SHA256SUMS stretches/{number}.done", "stretch/{number}"

_LAW, _INITIAL = LAW_NAME.pattern, STATE_NAME.pattern
#: {part of a name: its pattern}
_PATTERNS = {
    "run": rf"{_LAW}/{_INITIAL}/[A-Za-z]\w*?{VALUE}(?:_[A-Za-z]\w*?{VALUE})*",
    "law": _LAW,
    "initial": _INITIAL,
    "solver": "[a-z0-9]+",
    "a": f"a{VALUE}",
    "number": "[0-9]+",
}


def _names() -> list[str]:
    summaries = f"{_SUMMARIES} {_EARLIER_SUMMARIES}".split()
    figures = f"{_FIGURES} {_EARLIER_FIGURES}".split()
    texts = [
        "report.html",
        *(f"summary/{name}" for name in _TEXTS.split()),
        *(f"figures/{name}.{suffix}" for name in figures for suffix in ("pdf", "png")),
    ]
    jobs = [*f"{_JOBS} {_EARLIER_JOBS}".split(), *summaries, *(f"figure_{name}" for name in figures)]
    return [
        *f"{_OTHERS} {_EARLIER_OTHERS}".split(),
        *(f"summary/{name}.nc" for name in summaries),
        *texts,
        # Earlier versions set corrupt texts and pictures aside.
        *(f"{name}.corrupt" for name in texts),
        *(f"logs/{job}.log" for job in jobs),
        *(f"benchmarks/{job}.tsv" for job in jobs),
    ]


_NAMES = re.compile("|".join(_names()).replace(".", r"\.").format(**_PATTERNS))


def is_of_workflow(name: str) -> bool:
    """Return whether the workflow writes, or wrote, a file of that name, relative to the results of a study."""
    return _NAMES.fullmatch(name) is not None
