"""Stages that a config can leave out, and what they need to be installed."""

from __future__ import annotations

from importlib.util import find_spec

#: {stage: the stage whose results it uses, or an empty text}
STAGES = {
    "attractors": "",
    "bifurcations": "attractors",
    "edges": "attractors",
    "basins": "attractors",
    "phases": "attractors",
    "solvers": "",
    "two_blocks": "",
    "catalogue": "",
    "proof": "",
    "claims": "",
}

#: Numbers of blocks of the chains that the target `chains` computes by default.
CHAIN_LENGTHS = list(range(2, 11))


def missing_library(stage: str) -> str:
    """Return what has to be installed for a stage; empty if nothing is missing."""
    if stage == "proof" and find_spec("flint") is None:
        return "python-flint is not installed: `pip install python-flint`"
    return ""
