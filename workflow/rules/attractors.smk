# Attractors of each law along the grid of a and between its values, and all laws together.


rule attractors_of_law:
    """Search for the attractors of one friction law at every a, and insert values of a where they change."""
    output:
        attractors=f"{RESULTS}/attractors/{{law}}.nc",
        refined=f"{RESULTS}/refined/{{law}}.nc",
        returns=f"{RESULTS}/returns/{{law}}.nc",
    log:
        f"{RESULTS}/logs/attractors/{{law}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/attractors/{{law}}.tsv"
    # The longest jobs of a study start right after the points and the figures of the paper.
    priority: 2
    threads: shared_cores
    resources:
        mem_mb=memory(300),
        runtime=240,
        cpus_per_task=all_threads,
    params:
        config=uses("attractors_of_law", MODEL_OF_LAW, MOTION, "a", "initial", "start", "attractors", "refine"),
        sources=sources("attractors_of_law"),
    message:
        "attractors of the {wildcards.law} law along a"
    script:
        "../scripts/attractors_of_law.py"


rule attractors:
    """Merge the attractors of all friction laws, with their branches, basin fractions and rotation numbers."""
    input:
        attractors=expand(rules.attractors_of_law.output.attractors, law=STUDY.laws),
        refined=expand(rules.attractors_of_law.output.refined, law=STUDY.laws),
    output:
        attractors=f"{RESULTS}/summary/attractors.nc",
        text=shown("attractors.txt", "attractors in words", "Attractors"),
        refined=f"{RESULTS}/summary/refined.nc",
        rotation=f"{RESULTS}/summary/rotation.nc",
    log:
        f"{RESULTS}/logs/attractors.log",
    benchmark:
        f"{RESULTS}/benchmarks/attractors.tsv"
    threads: shared_cores
    resources:
        mem_mb=memory(400),
        cpus_per_task=all_threads,
    params:
        config=uses("attractors", MODELS, "a", "attractors"),
        sources=sources("attractors"),
    message:
        "attractors of all laws"
    script:
        "../scripts/attractors.py"
