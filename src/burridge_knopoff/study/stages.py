"""Stages that not every study has, and the summaries that each of them makes."""

#: {stage that can be left out: the stage whose results it takes, or nothing}
OPTIONAL = {
    "attractors": "",
    "bifurcations": "attractors",
    "basins": "attractors",
    "phases": "attractors",
    "solvers": "",
    "two_blocks": "",
    "proof": "",
    "claims": "",
}

#: Summaries of a stage, if they are not the one that has its name.
SUMMARIES = {"attractors": ("attractors", "refined", "rotation"), "claims": ()}

#: Summaries of longer chains, which have a target of their own.
CHAIN_SUMMARIES = ("chains", "two_blocks")

#: What a summary has beside its netCDF file, by suffix.
TEXTS = {"agreement": ("csv", "txt"), **dict.fromkeys(("attractors", "basins", "bifurcations", "proof"), ("txt",))}

#: All summaries that not every study has.
OPTIONAL_SUMMARIES = {name for stage in OPTIONAL for name in SUMMARIES.get(stage, (stage,))} | {*CHAIN_SUMMARIES}
