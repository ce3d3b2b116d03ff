# Phases: states by the phases of their end blocks, labelled for each law by the known attractors.

PHASES = STUDY.config["phases"]


rule phases_of_law:
    """Find out which initial phases of the end blocks lead to synchrony under one friction law."""
    input:
        f"{SUMMARY}/attractors.nc",
        RETURNS,
    output:
        f"{RESULTS}/phases/{{law}}.nc",
    log:
        f"{RESULTS}/logs/phases/{{law}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/phases/{{law}}.tsv"
    threads: SHARED_CORES
    resources:
        cpus_per_task=lambda wildcards, threads: threads,
        mem_mb=lambda wildcards, threads: 300 + 100 * threads,
        runtime=60,
    params:
        **keys(STUDY, "attractors"),
        blocks=STUDY.blocks,
        grid=PHASES["a"],
        phases={key: value for key, value in PHASES.items() if key != "a"},
        model=lambda wildcards: model_config(STUDY, [wildcards.law]),
        sources=sources("phases_of_law"),
        seals=seals,
    message:
        "phases of the end blocks, {wildcards.law} law"
    script:
        "../scripts/phases_of_law.py"


rule phases:
    """Merge the outcomes of initial phases of all friction laws."""
    input:
        expand(rules.phases_of_law.output, law=STUDY.laws),
    output:
        f"{SUMMARY}/phases.nc",
    log:
        f"{RESULTS}/logs/phases.log",
    benchmark:
        f"{RESULTS}/benchmarks/phases.tsv"
    group:
        group("summaries")
    params:
        summary="phases",
        sources=sources("merge", "summaries.phases"),
        seals=seals,
    message:
        "phases of the end blocks, all laws"
    script:
        "../scripts/merge.py"
