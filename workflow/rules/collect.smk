# The targets: the outputs of rules, of those that the study has. The other rules stay, for workflows that import them.
# Longer chains are part of `all` if the config has `chains.blocks`; the target `chains` makes them in any case.
WITHOUT = () if "blocks" in STUDY.config["chains"] else ("chains_summary", "figure_chains")
IN_ALL = [rule for rule in outputs() if rule not in WITHOUT]
SUMMARIES = made(*(rule for rule in IN_ALL if outputs()[rule].names.startswith("summary/")))
FIGURES = made(*(rule for rule in IN_ALL if outputs()[rule].names.startswith("figures/")))
CURVES = made(*(rule for rule in outputs() if stage_of(STUDY, rule) == "curves"))


rule points:
    """Simulate all points: each friction law from each initial state at each a, or at each point of the grid."""
    input:
        point_files(),


rule summary:
    """Compute all summaries of the study, and the verdicts on the claims of the paper."""
    input:
        SUMMARIES,


rule curves:
    """Draw the figures of the paper, or those over several parameters."""
    input:
        CURVES,
    message:
        f"the figures {'over the parameters' if STUDY.is_plane else 'of the paper'} are in {RESULTS}/figures"


rule figures:
    """Draw all figures of the study."""
    input:
        FIGURES,


rule chains:
    """Make the summary and the figure of longer chains, even if they are not part of `all`."""
    input:
        rules.chains_summary.output,
        rules.figure_chains.output,
    message:
        f"longer chains: {RESULTS}/summary/chains.nc and {RESULTS}/figures/chains.png"
