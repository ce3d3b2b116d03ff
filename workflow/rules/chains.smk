# Longer chains: an optional stage with its own target, `snakemake -c2 chains`.

# Long chains take longest and start first.
CHAIN_BLOCKS = sorted(CHAINS["blocks"], reverse=True)


rule chains:
    """Make the summaries and the figure of longer chains, which are not part of `all`."""
    input:
        f"{SUMMARY}/chains.nc",
        f"{SUMMARY}/two_blocks.nc",
        multiext(f"{FIGURES}/chains", ".pdf", ".png"),
    message:
        f"longer chains: {SUMMARY}/chains.nc, {SUMMARY}/two_blocks.nc and {FIGURES}/chains.png"


rule watch_chain:
    """Find out which sampled initial states of a longer chain end in mirror synchrony."""
    output:
        f"{RESULTS}/chains/blocks{{blocks}}.nc",
    log:
        f"{RESULTS}/logs/chains/blocks{{blocks}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/chains/blocks{{blocks}}.tsv"
    wildcard_constraints:
        blocks="|".join(map(str, CHAIN_BLOCKS)),
    priority: 1
    resources:
        runtime=30,
    params:
        model=lambda wildcards: other_length_config(STUDY, CHAINS["laws"]),
        grid=CHAINS["a"],
        watch={key: CHAINS[key] for key in ("time_limit", "synchronization_distance")},
        sample={
            "start": STUDY.config["start"],
            **{
                key: CHAINS[key]
                for key in (
                    "samples",
                    "symmetric_samples",
                    "seed",
                    "position",
                    "velocity",
                )
            },
        },
        motion=keys(STUDY, "synchronization_threshold"),
        sources=sources("watch_chain"),
        seals=seals,
    message:
        "mirror synchrony of sampled states, {wildcards.blocks} blocks"
    script:
        "../scripts/watch_chain.py"


rule chains_summary:
    """Merge the fractions of synchronizing initial states over chain length and a."""
    input:
        expand(rules.watch_chain.output, blocks=CHAIN_BLOCKS),
    output:
        f"{SUMMARY}/chains.nc",
    log:
        f"{RESULTS}/logs/chains.log",
    benchmark:
        f"{RESULTS}/benchmarks/chains.tsv"
    group:
        group("summaries")
    params:
        summary="chains",
        sources=sources("merge", "summaries.chains"),
        seals=seals,
    message:
        "fraction of synchronizing states over number of blocks and a"
    script:
        "../scripts/merge.py"
