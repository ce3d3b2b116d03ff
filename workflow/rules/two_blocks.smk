# Two blocks under each law, about which the paper makes a claim.


rule two_blocks:
    """Compare the motion of two blocks under each friction law with that under the first."""
    output:
        f"{RESULTS}/summary/two_blocks.nc",
    log:
        f"{RESULTS}/logs/two_blocks.log",
    benchmark:
        f"{RESULTS}/benchmarks/two_blocks.tsv"
    # A long job without inputs starts early, so that it does not run alone at the end.
    priority: 1
    threads: shared_cores
    resources:
        mem_mb=memory(300),
        runtime=30,
        cpus_per_task=all_threads,
    params:
        config=uses(
            "two_blocks",
            "laws",
            other_length_keys(STUDY),
            ["chains.seed", "chains.position", "chains.velocity", "chains.two_blocks"],
            ["start", "transient", "window", "agreement"],
            [f"attractors.{name}" for name in GIVEN_STATE_KEYS],
            # Two blocks may lack the block of the study's section; the sum always exists.
            ["motion", "synchronization_threshold"],
        ),
        sources=sources("two_blocks"),
    message:
        "two blocks: each law against the first one"
    script:
        "../scripts/two_blocks.py"
