# Initial states defined by the phases of their end blocks, and the attractors that they reach under each law.


rule phases_of_law:
    """Determine which initial phases of the end blocks lead to synchrony under one friction law."""
    input:
        attractors=rules.attractors.output.attractors,
        returns=rules.attractors_of_law.output.returns,
    output:
        f"{RESULTS}/phases/{{law}}.nc",
    log:
        f"{RESULTS}/logs/phases/{{law}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/phases/{{law}}.tsv"
    threads: shared_cores
    resources:
        mem_mb=memory(300),
        runtime=60,
        cpus_per_task=all_threads,
    params:
        config=uses("phases_of_law", MODEL_OF_LAW, "phases", "attractors"),
        sources=sources("phases_of_law"),
    message:
        "phases of the end blocks, {wildcards.law} law"
    script:
        "../scripts/phases_of_law.py"


rule phases:
    """Merge the outcomes of initial phases of all friction laws."""
    input:
        phases=expand(rules.phases_of_law.output, law=STUDY.laws),
    output:
        f"{RESULTS}/summary/phases.nc",
    log:
        f"{RESULTS}/logs/phases.log",
    benchmark:
        f"{RESULTS}/benchmarks/phases.tsv"
    params:
        config=uses("phases"),
        sources=sources("phases"),
    message:
        "phases of the end blocks, all laws"
    script:
        "../scripts/phases.py"
