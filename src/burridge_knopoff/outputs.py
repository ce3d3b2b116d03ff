"""The table of stages and files: what each rule of the workflow makes, and why a study does not have it.

The rules say how the files are made. `tests/workflow/test_rules.py` compares their outputs and logs with this table.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache
from typing import NamedTuple

from burridge_knopoff.figures.description import figure_descriptions
from burridge_knopoff.model.initial import STATE_NAME
from burridge_knopoff.model.model import LAW_NAME
from burridge_knopoff.proof.scope import LARGEST_V, NONLINEAR_V
from burridge_knopoff.study.chunks import chunks
from burridge_knopoff.study.keys import condition_refusal, length_refusal
from burridge_knopoff.study.paths import CHUNK, VALUE
from burridge_knopoff.study.stages import STAGES, missing_library
from burridge_knopoff.study.study import Study, all_points, solver_points

#: The wildcards of jobs.
Jobs = list[dict[str, str]]

_LAW, _INITIAL = LAW_NAME.pattern, STATE_NAME.pattern
#: {wildcard in the name of a file: its pattern}
WILDCARDS = {
    "run": rf"{_LAW}/{_INITIAL}/[A-Za-z]\w*?{VALUE}(?:_[A-Za-z]\w*?{VALUE})*",
    "law": _LAW,
    "initial": _INITIAL,
    "solver": "[a-z0-9]+",
    "a": VALUE,
    **dict.fromkeys(("tile", "blocks", "chunk"), "[0-9]+"),
}
#: {folder of results: that of the logs, if it has another name}
_LOG_FOLDERS = {
    "summary": "",
    "figures": "figure_",
    "points": "simulate/",
    "solvers": "simulate_solver/",
    "chunks": "chunk/",
}

#: The stages that no config can leave out; `curves` are the figures of the paper, or those over several parameters.
ALWAYS = ("points", "summary", "curves", "figures", "chains", "report")


@dataclass(frozen=True)
class Outputs:
    """The files that one rule makes.

    stage : the stage of the study to which it belongs, one of `STAGES` or `ALWAYS`
    names : of its files in the results, with wildcards in braces; the log of a job has the name of the first
    jobs : the wildcards of all its jobs in a study
    over : the studies that can have it: over `a` alone, over `several` parameters, or over `any`
    lack : what a study lacks to have it, an empty text if nothing
    needs : the rules without whose files a study does not have it
    """

    stage: str
    names: str
    jobs: Callable[[Study], Jobs] = lambda study: [{}]
    over: str = "a"
    lack: Callable[[Study], str] = lambda study: ""
    needs: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if self.stage not in (*STAGES, *ALWAYS):
            raise ValueError(f"stage: got {self.stage}, expected {' | '.join((*STAGES, *ALWAYS))}")


def _laws(study: Study) -> Jobs:
    return [{"law": law} for law in study.laws]


def _maps(study: Study) -> Jobs:
    return [{"law": law, "a": a} for law, a in study.basin_maps]


def _tiles(study: Study) -> Jobs:
    return [{**job, "tile": f"{tile}"} for job in _maps(study) for tile in range(study.config["basins"]["tiles"])]


def _catalogues(study: Study) -> Jobs:
    return [{"law": law, "a": a} for law in study.laws for a in study.catalogue_a]


def _other_lengths(study: Study) -> Jobs:
    # Long chains take longest and start first.
    return [{"blocks": f"{blocks}"} for blocks in sorted(study.chain_lengths, reverse=True)]


def _states(study: Study) -> Jobs:
    return [{"initial": initial} for initial in study.initial]


def _no_maps(study: Study) -> str:
    return "" if study.basin_maps else "no maps of basins: `basins.a` names no value of a"


def _no_phases(study: Study) -> str:
    return "" if study.config["phases"]["a"] else "no phases of end blocks: `phases.a` names no value of a"


def _no_edges(study: Study) -> str:
    return "" if study.config.get("edges", {}).get("a") else "no edge states: add `edges: {}` to its config"


def _no_catalogue(study: Study) -> str:
    return "" if "catalogue" in study.config else "no catalogues of slip events: add `catalogue: {}` to its config"


def _no_proof(study: Study) -> str:
    scope = f"linearized: any v, at most {LARGEST_V:g} under a symmetric contact; nonlinear: v = {NONLINEAR_V:g}"
    words = f"nothing to prove: the proof covers the paper's chain of 3 blocks and its two laws ({scope})"
    return "" if study.proved_laws else words


def _no_pair(study: Study) -> str:
    words = "no comparison for two blocks: add `chains: {two_blocks: {}}` to its config"
    reason = length_refusal(study) or condition_refusal(study, "has_several_laws")
    return reason or ("" if "two_blocks" in study.config["chains"] else words)


def _meets(condition: str) -> Callable[[Study], str]:
    return lambda study: condition_refusal(study, condition)


@cache
def outputs() -> dict[str, Outputs]:
    """Return {rule: what it makes}, in the order of the workflow."""
    rules = {
        "simulate": Outputs("points", "points/{run}.nc", all_points, "any"),
        "simulate_solver": Outputs("solvers", "solvers/{solver}/{run}.nc", solver_points, "any"),
        "chunk": Outputs("points", CHUNK, lambda study: [{"chunk": chunk} for chunk in chunks(study)], "several"),
        "runs": Outputs("summary", "summary/runs.nc", over="any"),
        "mean_distance": Outputs("summary", "summary/mean_distance.nc", over="any"),
        "bifurcation_diagram": Outputs("summary", "summary/bifurcation_diagram.nc"),
        "lyapunov": Outputs("summary", "summary/lyapunov.nc", over="any"),
        "stick_slip": Outputs("summary", "summary/stick_slip.nc"),
        "agreement": Outputs("summary", "summary/agreement.nc summary/agreement.csv summary/agreement.txt"),
        "orbits": Outputs("summary", "summary/orbits.nc"),
        "equilibrium": Outputs("summary", "summary/equilibrium.nc"),
        "attractors_of_law": Outputs("attractors", "attractors/{law}.nc refined/{law}.nc returns/{law}.nc", _laws),
        "attractors": Outputs(
            "attractors", "summary/attractors.nc summary/attractors.txt summary/refined.nc summary/rotation.nc"
        ),
        "basin_tile": Outputs("basins", "basins/{law}/a{a}/tile{tile}.nc", _tiles),
        "basin_pairs": Outputs("basins", "basins/{law}/a{a}/pairs.nc", _maps),
        "basins": Outputs("basins", "summary/basins.nc summary/basins.txt", lack=_no_maps),
        "bifurcations_of_law": Outputs("bifurcations", "bifurcations/{law}.nc", _laws),
        "bifurcations": Outputs("bifurcations", "summary/bifurcations.nc summary/bifurcations.txt"),
        "edges_of_law": Outputs("edges", "edges/{law}.nc", _laws, lack=_no_edges),
        "edges": Outputs("edges", "summary/edges.nc summary/edges.txt", lack=_no_edges),
        "phases_of_law": Outputs("phases", "phases/{law}.nc", _laws, lack=_no_phases),
        "phases": Outputs("phases", "summary/phases.nc", lack=_no_phases),
        "solvers": Outputs("solvers", "summary/solvers.nc"),
        "proof": Outputs("proof", "summary/proof.nc summary/proof.txt", lack=_no_proof),
        "two_blocks": Outputs("two_blocks", "summary/two_blocks.nc", lack=_no_pair),
        "catalogue_of_run": Outputs("catalogue", "catalogues/{law}/a{a}.nc", _catalogues, lack=_no_catalogue),
        "catalogue": Outputs("catalogue", "summary/catalogue.nc", lack=_no_catalogue),
        "watch_chain": Outputs("chains", "chains/blocks{blocks}.nc", _other_lengths, lack=length_refusal),
        "chains_summary": Outputs("chains", "summary/chains.nc", lack=length_refusal),
    }
    maker = {name: rule for rule, item in rules.items() for name in item.names.split()}
    for figure in figure_descriptions():
        rules[f"figure_{figure.name}"] = Outputs(
            "curves" if figure.paper or figure.over == "several" else "figures",
            f"figures/{figure.file}.pdf figures/{figure.file}.png",
            _states if "{initial}" in figure.file else lambda study: [{}],
            figure.over,
            _meets(figure.condition),
            () if figure.of_points else tuple(maker[f"summary/{name}.nc"] for name in figure.inputs),
        )
    verdicts = "summary/claims.json summary/claims.csv summary/claims.md"
    rules["claims"] = Outputs("claims", verdicts, lack=_meets("has_paper_chain"))
    rules["report"] = Outputs("report", "report.html", over="any")
    return rules


def stage_of(study: Study, rule: str) -> str:
    """Return the stage of a rule: in a study of several parameters all figures are the curves."""
    stage = outputs()[rule].stage
    return "curves" if study.is_plane and stage == "figures" else stage


def omission(study: Study, rule: str) -> str:
    """Return why a study does not have the files of a rule, in a line; empty if it has."""
    item = outputs()[rule]
    reasons = (study.omission(item.stage, item.over), item.lack(study), *(omission(study, need) for need in item.needs))
    return next(filter(None, reasons), "")


def refusal(study: Study, rule: str) -> str:
    """Return why the files of a rule are not made: the study does not have them, or a library is missing here."""
    return omission(study, rule) or missing_library(outputs()[rule].stage)


class File(NamedTuple):
    """The rule that makes a file, and the log of its job."""

    rule: str
    log: str


def study_files(study: Study) -> dict[str, File]:
    """Return {file of a study, except point files: its rule and log}, by their names in the results."""
    return {
        name.format(**job): File(rule, log_of(item.names.split()[0].format(**job)))
        for rule, item in outputs().items()
        if "{run}" not in item.names and not omission(study, rule)
        for job in item.jobs(study)
        for name in item.names.split()
    }


def log_of(name: str) -> str:
    """Return the log of the job whose first file has a name; both may have wildcards."""
    head, separator, rest = name.partition("/")
    place = _LOG_FOLDERS.get(head, f"{head}/") if separator else ""
    return f"logs/{place}{(rest or head).rpartition('.')[0]}.log"


def benchmark_of(log: str) -> str:
    """Return the file with the duration of the job of a log."""
    return f"benchmarks{log.removeprefix('logs').removesuffix('.log')}.tsv"


def rule_of(name: str) -> str:
    """Return the rule that makes files of a name in the results of some study; empty if none does."""
    return next((rule for rule, _, _ in _jobs_of(name)), "")


def job_log(name: str) -> str:
    """Return the log of the job that makes a file of a name in the results of some study; empty if none does."""
    return next((log_of(first.format(**job)) for _, first, job in _jobs_of(name)), "")


def _jobs_of(name: str) -> Iterator[tuple[str, str, dict[str, str]]]:
    """Yield the rule, the first file and the wildcards of the jobs that make a file of a name."""
    for pattern, rule, first in _patterns():
        if match := pattern.fullmatch(name):
            yield rule, first, match.groupdict()


@cache
def _patterns() -> list[tuple[re.Pattern[str], str, str]]:
    groups = {name: f"(?P<{name}>{pattern})" for name, pattern in WILDCARDS.items()}
    return [
        (re.compile(name.replace(".", r"\.").format(**groups)), rule, item.names.split()[0])
        for rule, item in outputs().items()
        for name in item.names.split()
    ]
