"""The summaries of points, and of models alone: a row each, from which its rule, its files and their check follow.

Each is made by the module of its name in `summaries`. Those of optional stages have rules of their own.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from burridge_knopoff.study import stages


@dataclass(frozen=True)
class SummaryRow:
    """What makes a summary.

    purpose : a sentence, the docstring of its rule
    of : what it is made from, points or models
    keys : of the config, those that it uses
    summaries : names of other summaries that it reads, if the study has them
    texts : {suffix of a text file that comes with it: what the text is}
    memory : of its job, in MB
    """

    purpose: str
    of: str = "points"
    keys: tuple[str, ...] = ()
    summaries: tuple[str, ...] = ()
    texts: Mapping[str, str] = field(default_factory=dict)
    memory: int = 400


SUMMARY_ROWS = {
    "mean_distance": SummaryRow(
        "Average the distance J between the end blocks over each run.",
        keys=("synchronization_threshold",),
    ),
    "bifurcation_diagram": SummaryRow(
        "Collect the section points of all runs for the bifurcation diagrams.",
        memory=1000,
    ),
    "lyapunov": SummaryRow(
        "Estimate the Lyapunov exponents of each run and tell its kind of motion.",
        keys=("lyapunov_exponents", "synchronization_threshold", "motion"),
    ),
    "agreement": SummaryRow(
        "Judge where each friction law agrees with the first one.",
        keys=("synchronization_threshold", "agreement"),
        summaries=("lyapunov", "attractors"),
        texts={"csv": "table of the agreement", "txt": "agreement in words"},
    ),
    "stick_slip": SummaryRow(
        "Measure the stick-slip cycles of each block in each run.",
        keys=("transient", "window", "batches"),
    ),
    "orbits": SummaryRow(
        "Follow the synchronized orbit in a to where it loses its stability, and the orbit that branches off there.",
        of="models",
    ),
    "equilibrium": SummaryRow(
        "Find uniform sliding and the eigenvalues of its perturbations.",
        of="models",
    ),
    "grid": SummaryRow(
        "Collect the numbers of all runs over the study's parameters.",
        keys=("lyapunov_exponents", "synchronization_threshold", "motion"),
    ),
}

#: Suffixes of the text files that come with the netCDF file of a summary, by its name; those of stages included.
TEXTS = {**stages.TEXTS, **{name: tuple(row.texts) for name, row in SUMMARY_ROWS.items() if row.texts}}
