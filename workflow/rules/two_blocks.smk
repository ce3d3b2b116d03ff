# Two blocks under each law: every study judges a statement of the paper about them.
from burridge_knopoff.attractors.settings import OF_GIVEN_STATES

CHAINS = STUDY.config["chains"]


rule two_blocks:
    """Compare the motion of two blocks under each friction law with that under the first law."""
    output:
        f"{SUMMARY}/two_blocks.nc",
    log:
        f"{RESULTS}/logs/two_blocks.log",
    benchmark:
        f"{RESULTS}/benchmarks/two_blocks.tsv"
    # A long job that waits for nothing: started early, so that it does not run alone at the end.
    priority: 1
    threads: SHARED_CORES
    resources:
        cpus_per_task=lambda wildcards, threads: threads,
        mem_mb=lambda wildcards, threads: 300 + 100 * threads,
        runtime=30,
    params:
        **keys(STUDY, "agreement"),
        model=lambda wildcards: other_length_config(STUDY),
        sample={key: CHAINS[key] for key in ("seed", "position", "velocity")},
        two_blocks=CHAINS["two_blocks"],
        settings=keys(STUDY, "start", "transient", "window"),
        search={key: STUDY.config["attractors"][key] for key in OF_GIVEN_STATES},
        # The block of the study's section may not exist here; the sum always does.
        motion={
            key: value
            for key, value in motion_config(STUDY).items()
            if key != "section"
        },
        sources=sources("two_blocks"),
        seals=seals,
    message:
        "two blocks: each law against the first one"
    script:
        "../scripts/two_blocks.py"
