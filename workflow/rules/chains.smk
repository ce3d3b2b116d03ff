# Chains of other lengths: for the target `chains`, or in every run if the config has `chains.blocks`.


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
            "watch_chain",
            [f"laws.{law}" for law in STUDY.config["chains"]["laws"]],
            other_length_keys(STUDY),
            parts(STUDY, "chains", "blocks", "two_blocks"),
            "start",
            "synchronization_threshold",
        ),
        sources=sources("watch_chain"),
    message:
        "mirror synchrony of sampled states, {wildcards.blocks} blocks"
    script:
        "../scripts/watch_chain.py"


rule chains_summary:
    """Merge the fractions of synchronizing initial states over chain length and a."""
    input:
        chains=made("watch_chain"),
    output:
        f"{RESULTS}/summary/chains.nc",
    log:
        f"{RESULTS}/logs/chains.log",
    benchmark:
        f"{RESULTS}/benchmarks/chains.tsv"
    params:
        config=uses("chains_summary"),
        sources=sources("chains_summary"),
    message:
        "fraction of synchronizing states over number of blocks and a"
    script:
        "../scripts/chains_summary.py"
