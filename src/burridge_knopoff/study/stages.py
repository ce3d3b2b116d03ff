"""Optional stages of a study, and the summaries that each makes."""

#: {optional stage: the stage whose results it uses, or empty}
OPTIONAL = {
    "attractors": "",
    "bifurcations": "attractors",
    "basins": "attractors",
    "phases": "attractors",
    "solvers": "",
    "two_blocks": "",
    "catalogue": "",
    "proof": "",
    "claims": "",
}

#: The summaries of a study over several parameters, which has no others and no stages.
OF_PLANE = ("grid",)

#: Summaries of a stage, unless it makes one summary of its own name.
SUMMARIES = {"attractors": ("attractors", "refined", "rotation"), "claims": ()}

#: Summaries of longer chains, which have their own target.
CHAIN_SUMMARIES = ("chains", "two_blocks")

#: Suffixes of the text files that come with the netCDF file of a summary of a stage.
TEXTS = dict.fromkeys(("attractors", "basins", "bifurcations", "proof"), ("txt",))

#: All summaries of optional stages and of longer chains.
OPTIONAL_SUMMARIES = {name for stage in OPTIONAL for name in SUMMARIES.get(stage, (stage,))} | {*CHAIN_SUMMARIES}
