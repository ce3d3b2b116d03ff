# Attractors: found for each law along the grid of a and between its values, then merged.

OF_LAW = [
    f"{RESULTS}/{folder}/{{law}}.nc" for folder in ("attractors", "refined", "returns")
]

# Their section returns, by which states are labelled.
RETURNS = OF_LAW[2]


# The settings that decide the attractors of one law, except the values of a.
SEARCH_PARAMS = {
    **keys(STUDY, "initial", "start", "attractors", "refine"),
    "motion": motion_config(STUDY),
}


rule attractors_of_law:
    """Search for the coexisting attractors of one friction law at every a, and refine a where they change."""
    output:
        OF_LAW,
    log:
        f"{RESULTS}/logs/attractors/{{law}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/attractors/{{law}}.tsv"
    # The longest jobs of a study, started right after the points and the figures of the paper.
    priority: 2
    threads: SHARED_CORES
    resources:
        # A profile sets this if threads are the width of a group: `cores` in workflow/profiles/slurm.
        cpus_per_task=lambda wildcards, threads: threads,
        mem_mb=lambda wildcards, threads: 300 + 100 * threads,
        runtime=240,
    params:
        **SEARCH_PARAMS,
        grid=list(STUDY.grid.values()),
        model=lambda wildcards: model_config(STUDY, [wildcards.law]),
        sources=sources("attractors_of_law"),
        seals=seals,
        kept=lambda wildcards: cache_folder(
            STUDY,
            f"attractors {wildcards.law}",
            SEARCH_PARAMS,
            model_config(STUDY, [wildcards.law]),
            source_fingerprint("burridge_knopoff.continuation.along_a"),
        ),
    message:
        "attractors of the {wildcards.law} law along a"
    script:
        "../scripts/attractors_of_law.py"


rule attractors:
    """Merge the attractors of all friction laws, with their branches, basin fractions and rotation numbers."""
    input:
        grid=expand(OF_LAW[0], law=STUDY.laws),
        refined=expand(OF_LAW[1], law=STUDY.laws),
    output:
        f"{SUMMARY}/attractors.nc",
        report(
            f"{SUMMARY}/attractors.txt",
            caption="../report/attractors_text.rst",
            category="Attractors",
            labels={"result": "attractors in words", "paper": "none"},
        ),
        f"{SUMMARY}/refined.nc",
        f"{SUMMARY}/rotation.nc",
    log:
        f"{RESULTS}/logs/attractors.log",
    benchmark:
        f"{RESULTS}/benchmarks/attractors.tsv"
    threads: SHARED_CORES
    resources:
        mem_mb=lambda wildcards, threads: 400 + 100 * threads,
        runtime=10,
    params:
        **keys(STUDY, "attractors"),
        model=model_config(STUDY),
        a=list(STUDY.grid.values())[0],
        blocks=STUDY.blocks,
        sources=sources("attractors"),
        seals=seals,
    message:
        "attractors of all laws"
    script:
        "../scripts/attractors.py"
