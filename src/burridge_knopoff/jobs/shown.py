"""Summaries of points and of models, figures, claims and the report."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from burridge_knopoff.claims.claim import FILE, claims_of
from burridge_knopoff.claims.ledger import READS
from burridge_knopoff.figures.description import Description, figure_descriptions
from burridge_knopoff.jobs.params import (
    condition_refusal,
    model_keys,
    point_keys,
    run_keys,
    study_keys,
)
from burridge_knopoff.jobs.rule import Rule, Shown, Wildcards
from burridge_knopoff.study.study import Study
from burridge_knopoff.study.yaml_file import read_yaml

#: Priority of the figures of the paper, which are made first, and of the summaries that they show.
FIRST = 4


def summaries(study: Study) -> list[Rule]:
    """Summaries of points, and of models without points: one netCDF file per question, by the module of its name."""
    of_paper = {name for figure in figure_descriptions() if figure.paper for name in figure.inputs}

    def point_summary(
        name: str,
        purpose: str,
        *used: str,
        read: Sequence[str] = (),
        texts: Mapping[str, str] | None = None,
        memory: int = 400,
        over: str = "a",
    ) -> Rule:
        """used : keys of the config; read : other summaries; texts : {suffix of a text next to it: title}."""
        shown = {
            f"summary/{name}.{suffix}": Shown(title, "Friction laws", f"{name}_{suffix}")
            for suffix, title in (texts or {}).items()
        }
        return Rule(
            name,
            purpose,
            f"summary: {name}",
            (f"summary/{name}.nc", *shown),
            "summaries.of_points:make",
            (f"summaries.{name}",),
            reads={"summaries": [f"summary/{other}.nc" for other in read]},
            optional_reads=True,
            points=lambda job: study.points,
            keys=lambda job: [*point_keys(study), *used],
            over=over,
            shown=shown,
            memory=memory,
            minutes=30,
            priority=FIRST * (name in of_paper),
            group="summaries",
        )

    def model_summary(name: str, purpose: str) -> Rule:
        return Rule(
            name,
            purpose,
            f"summary: {name}",
            (f"summary/{name}.nc",),
            "summaries.of_models:make",
            (f"summaries.{name}",),
            keys=lambda job: [*model_keys(), "a"],
            memory=400,
            minutes=30,
            priority=FIRST * (name in of_paper),
            group="summaries",
        )

    return [
        point_summary(
            "mean_distance",
            "Average the distance J between the end blocks over each run.",
            "synchronization_threshold",
        ),
        point_summary(
            "bifurcation_diagram",
            "Collect the section points of all runs for the bifurcation diagrams.",
            memory=1000,
        ),
        point_summary(
            "lyapunov",
            "Estimate the Lyapunov exponents of each run and determine its kind of motion.",
            *("lyapunov_exponents", "synchronization_threshold", "motion"),
        ),
        point_summary(
            "agreement",
            "Determine where each friction law agrees with the first.",
            *("synchronization_threshold", "agreement"),
            read=("lyapunov", "attractors"),
            texts={"csv": "table of the agreement", "txt": "agreement in words"},
        ),
        point_summary(
            "stick_slip",
            "Measure the stick-slip cycles of each block in each run.",
            *("transient", "window", "batches"),
        ),
        model_summary(
            "orbits",
            "Continue the synchronized orbit in a to its loss of stability, and the orbit that branches off there.",
        ),
        model_summary(
            "equilibrium",
            "Find uniform sliding and the eigenvalues of its perturbations.",
        ),
        point_summary(
            "grid",
            "Collect the results of all runs over the study's parameters.",
            *("lyapunov_exponents", "synchronization_threshold", "motion"),
            over="several",
        ),
    ]


def figures(study: Study) -> list[Rule]:
    """One figure for each module of `figures` that has a caption, as PDF for print and PNG for the screen."""
    return [_figure(study, figure) for figure in figure_descriptions()]


def _figure(study: Study, figure: Description) -> Rule:
    files = tuple(f"figures/{figure.file}.{suffix}" for suffix in ("pdf", "png"))
    # The name of a figure of runs from one initial state contains the name of the state.
    of_states = "{initial}" in figure.file
    words = figure.caption_of({"initial": "{initial}"})
    properties = [key for name in figure.from_study for key in study_keys(study, name)]

    def keys(job: Wildcards) -> list[str]:
        if not figure.of_runs:
            return properties
        state = f"initial.{job['initial']}" if job else "initial"
        return [*run_keys(study, study.shown_law), state, "figures.a", "figures.law"]

    return Rule(
        f"figure_{figure.name}",
        f"Draw {figure.subject}",
        f"figure: {figure.title}",
        files,
        f"figures.{'of_runs' if figure.of_runs else 'of_summaries'}:make",
        (f"figures.{figure.name}",),
        reads={} if figure.of_runs else {"summaries": [f"summary/{name}.nc" for name in figure.inputs]},
        points=study.shown_runs if figure.of_runs else None,
        keys=keys,
        each=[{"initial": initial} for initial in study.initial] if of_states else ({},),
        stage="figures",
        over="a" if figure.of_runs else "any",
        exists=not figure.condition or bool(getattr(study, figure.condition)),
        refusal=condition_refusal(study, figure.condition),
        shown={files[1]: Shown(figure.title, figure.category, "figure", figure.paper or "none", words)},
        priority=FIRST if figure.paper else 0,
        group="figures",
    )


def claims(study: Study, pictures: Sequence[str]) -> list[Rule]:
    """The verdict on each claim of the paper, from the summaries; pictures : the figures of the study."""
    return [
        Rule(
            "claims",
            "Judge every claim of the paper from the summaries.",
            "verdicts on the claims of the paper",
            tuple(f"summary/claims.{suffix}" for suffix in ("json", "csv", "md")),
            "claims.making:make",
            reads={"summaries": [f"summary/{name}.nc" for name in READS]},
            optional_reads=True,
            keys=lambda job: [
                *model_keys(),
                *("study", "start", "transient", "window", "initial", "motion"),
            ],
            # Another figure leaves the verdicts as they are.
            figures=sorted({claim.figure for claim in claims_of(read_yaml(FILE))} & {*pictures}),
            stage="claims",
            shown={"summary/claims.csv": Shown("claims of the paper", "Claims", "claims_csv", "all")},
            memory=1000,
            minutes=10,
            group="summaries",
        )
    ]


def report(study: Study, files: Sequence[str]) -> list[Rule]:
    """The report, one HTML file that opens offline; files : those of the study, except points."""
    return [
        Rule(
            "report",
            "Write the report of the study, one HTML file that opens offline.",
            f"report: results/{study.name}/report.html",
            ("report.html",),
            "report.page:make",
            reads={
                "claims": ["summary/claims.json"],
                "summaries": [file for file in files if file.startswith("summary/") and file.endswith(".nc")],
                "figures": [file for file in files if file.endswith(".png")],
            },
            optional_reads=True,
            # The report shows the whole config.
            keys=lambda job: list(study.config),
            # The page draws the moving blocks of single runs.
            points=None if study.is_plane else lambda job: study.points,
            stage="report",
            over="any",
            memory=600,
            minutes=10,
            group="figures",
        )
    ]
