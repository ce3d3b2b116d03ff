# Chains of other lengths: for the target `chains`, or in every run if the config has `chains.blocks`.
LENGTHS = [
    # Long chains take longest and start first.
    {"blocks": f"{blocks}"}
    for blocks in sorted(STUDY.chain_lengths, reverse=True)
]


rule chains:
    """Make the summary and the figure of longer chains, even if they are not part of `all`."""
    input:
        f"{RESULTS}/summary/chains.nc",
        f"{RESULTS}/figures/chains.pdf",
        f"{RESULTS}/figures/chains.png",
    message:
        f"longer chains: {RESULTS}/summary/chains.nc and {RESULTS}/figures/chains.png"


rule watch_chain:
    """Determine which sampled initial states of a chain end in mirror synchrony."""
    output:
        f"{RESULTS}/chains/blocks{{blocks}}.nc",
    log:
        f"{RESULTS}/logs/chains/blocks{{blocks}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/chains/blocks{{blocks}}.tsv"
    wildcard_constraints:
        blocks=r"\d+",
    priority: 1
    resources:
        runtime=30,
    params:
        config=uses(
            [f"laws.{law}" for law in STUDY.config["chains"]["laws"]],
            other_length_keys(STUDY),
            parts(STUDY, "chains", "blocks", "two_blocks"),
            "start",
            "synchronization_threshold",
            stage="chains",
            jobs=LENGTHS,
            refusal=length_refusal(STUDY),
            by_name="blocks" not in STUDY.config["chains"],
        ),
        sources=sources("watch_chain"),
    message:
        "mirror synchrony of sampled states, {wildcards.blocks} blocks"
    script:
        "../scripts/watch_chain.py"


rule chains_summary:
    """Merge the fractions of synchronizing initial states over chain length and a."""
    input:
        chains=jobs_of(rules.watch_chain, LENGTHS),
    output:
        f"{RESULTS}/summary/chains.nc",
    log:
        f"{RESULTS}/logs/chains.log",
    benchmark:
        f"{RESULTS}/benchmarks/chains.tsv"
    params:
        config=uses(stage="chains", refusal=length_refusal(STUDY)),
        sources=sources("chains_summary"),
    message:
        "fraction of synchronizing states over number of blocks and a"
    script:
        "../scripts/chains_summary.py"
