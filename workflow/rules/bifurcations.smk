# Bifurcations: bifurcations and crises of the branches of attractors, for each law, then merged.


rule bifurcations_of_law:
    """Continue the periodic orbits of one friction law in a to the bifurcations where their branches begin or end."""
    input:
        attractors=f"{SUMMARY}/attractors.nc",
        refined=f"{SUMMARY}/refined.nc",
    output:
        f"{RESULTS}/bifurcations/{{law}}.nc",
    log:
        f"{RESULTS}/logs/bifurcations/{{law}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/bifurcations/{{law}}.tsv"
    threads: SHARED_CORES
    resources:
        cpus_per_task=lambda wildcards, threads: threads,
        mem_mb=lambda wildcards, threads: 350 + 100 * threads,
        runtime=60,
    params:
        model=lambda wildcards: model_config(STUDY, [wildcards.law]),
        blocks=STUDY.blocks,
        a=min(STUDY.grid.values()),
        sources=sources("bifurcations_of_law"),
        seals=seals,
        kept=lambda wildcards: cache_folder(
            STUDY,
            f"bifurcations {wildcards.law}",
            model_config(STUDY, [wildcards.law]),
            source_fingerprint("burridge_knopoff.continuation.bifurcations"),
        ),
    message:
        "bifurcations of the branches of attractors, {wildcards.law} law"
    script:
        "../scripts/bifurcations_of_law.py"


rule bifurcations:
    """Merge the bifurcations of all friction laws."""
    input:
        expand(rules.bifurcations_of_law.output, law=STUDY.laws),
    output:
        f"{SUMMARY}/bifurcations.nc",
        report(
            f"{SUMMARY}/bifurcations.txt",
            caption="../report/bifurcations_text.rst",
            category="Attractors",
            labels={"result": "bifurcations in words", "paper": "none"},
        ),
    log:
        f"{RESULTS}/logs/bifurcations.log",
    benchmark:
        f"{RESULTS}/benchmarks/bifurcations.tsv"
    group:
        group("summaries")
    params:
        summary="bifurcations",
        sources=sources("merge", "summaries.bifurcations"),
        seals=seals,
    message:
        "bifurcations of all laws"
    script:
        "../scripts/merge.py"
