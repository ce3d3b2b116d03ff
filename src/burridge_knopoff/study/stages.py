"""Stages that a config can leave out, and the summaries that each of them makes."""

from __future__ import annotations

from collections.abc import Collection

#: {stage that can be left out: the stage whose results it takes, or nothing}
OPTIONAL = {
    "attractors": "",
    "edges": "attractors",
    "basins": "attractors",
    "phases": "attractors",
    "solvers": "",
    "two_blocks": "",
    "proof": "",
    "claims": "",
}

#: Summaries of a stage, if they are not the one that has its name.
SUMMARIES = {"attractors": ("attractors", "refined"), "claims": ()}


def left_out(without: Collection[str]) -> tuple[str, ...]:
    """Return the stages that a study lacks whose config names some: these, and all that take what they make."""
    return tuple(stage for stage, needed in OPTIONAL.items() if stage in without or needed in without)


def summaries_of(stages: Collection[str]) -> tuple[str, ...]:
    """Return the names of the netCDF summaries that some of these stages make."""
    return tuple(name for stage in OPTIONAL if stage in stages for name in SUMMARIES.get(stage, (stage,)))
