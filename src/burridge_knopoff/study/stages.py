"""Stages that a config can leave out; their rules are in `jobs`."""

#: {stage: the stage whose results it uses, or empty}
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

#: Numbers of blocks of longer chains that are asked for by name.
CHAIN_LENGTHS = list(range(2, 11))
