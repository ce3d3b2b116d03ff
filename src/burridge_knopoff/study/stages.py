"""Stages that a config can leave out; their rules are in `jobs`."""

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
