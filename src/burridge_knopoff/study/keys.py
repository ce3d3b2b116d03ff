"""The keys of a config on which the files of jobs depend, see `provenance.keys`."""

from __future__ import annotations

from burridge_knopoff.model.fields import fields_of
from burridge_knopoff.running.settings import Settings
from burridge_knopoff.running.solvers import SOLVERS
from burridge_knopoff.study.model import MODEL_KEYS
from burridge_knopoff.study.study import Study

#: {property of `Study` on which a rule depends: what a study needs to have it}
_CONDITIONS = {
    "has_several_laws": "a second law in `laws`",
    "has_synchronized_orbit": "a mirror-symmetric chain of 3 blocks",
    "has_one_chain": "the same chain at all points",
    "has_end_blocks": "two or more blocks",
    "has_paper_chain": "the paper's chain of 3 blocks",
}


def parts(study: Study, section: str, *without: str) -> list[str]:
    """Return the keys of a section, except some."""
    return [f"{section}.{name}" for name in study.config[section] if name not in without]


def other_length_keys(study: Study) -> list[str]:
    """Return the keys that define the models of chains of other lengths, except their laws."""
    return ["v", "contact", *parts(study, "chain", "blocks")]


def run_keys(study: Study, law: str = "") -> list[str]:
    """Return the keys that define the runs of points, under one law or all, without the grid."""
    names = [name for name in fields_of(Settings) if name in study.config]
    solvers = (study.config["solver"][name] for name in ([law] if law else study.laws))
    if not any(SOLVERS[solver].has_fixed_step for solver in solvers):
        names.remove("step")
    law_keys = [f"laws.{law}", f"solver.{law}"] if law else ["laws", "solver"]
    return [*law_keys, *MODEL_KEYS[1:], *(name for name in names if name != "solver"), "a_digits"]


def point_keys(study: Study) -> list[str]:
    """Return the keys that define all points."""
    return [*run_keys(study), "initial", "grid" if study.is_plane else "a"]


def study_keys(study: Study, name: str) -> list[str]:
    """Return the keys that decide a property of `Study` in a figure."""
    chain = ["chain", "grid", "a_digits"] if study.is_plane else ["chain"]
    return {
        "marked_states": [*MODEL_KEYS, "initial", "basins.initial", "basins.a"],
        "chain": chain,
        "has_paper_chain": chain,
        "law_descriptions": ["laws"],
        "shown_a": ["figures.a"],
        "shown_law": ["figures.law"],
    }[name]


def length_refusal(study: Study) -> str:
    """Return the reason why a study can have no chains of other lengths; empty if it can."""
    if key := study.single_length_key:
        return f"chain.{key}: got {study.config['chain'][key]}, expected one number for chains of other lengths"
    return ""


def condition_refusal(study: Study, condition: str) -> str:
    """Return what a study needs to meet a condition, the name of a property of `Study`; empty if it meets it."""
    if not condition or getattr(study, condition):
        return ""
    return f"it needs {_CONDITIONS.get(condition, condition)}"
