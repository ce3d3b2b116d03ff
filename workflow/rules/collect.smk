# The targets: what `snakemake points`, `summary`, `figures` and the others make. A rule that the study does not have stays, for
# workflows that import it, but makes none of these files.
# Longer chains are made in every run if the config has `chains.blocks`, otherwise for the target `chains`.
CHAINS = "blocks" in STUDY.config["chains"]
SUMMARIES = made(
    *("runs", "mean_distance", "bifurcation_diagram", "lyapunov", "stick_slip", "agreement", "orbits", "equilibrium"),
    *("attractors", "basins", "bifurcations", "edges", "phases"),
    *("solvers", "proof", "two_blocks", "catalogue", "claims"),
    *(["chains_summary"] if CHAINS else []),
)
FIGURES = made(*(f"figure_{figure.name}" for figure in figure_descriptions() if CHAINS or figure.inputs != ("chains",)))
CURVES = made(*(f"figure_{figure.name}" for figure in figure_descriptions() if figure.paper or STUDY.is_plane))


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
