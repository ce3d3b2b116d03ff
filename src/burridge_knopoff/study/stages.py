"""Stages that a config can leave out, and the summaries that each of them makes."""

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
