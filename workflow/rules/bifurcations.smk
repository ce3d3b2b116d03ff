# Bifurcations and crises of the branches of attractors, and the edge states on the boundaries between their basins.


rule bifurcations_of_law:
    """Continue the periodic orbits of one friction law in a to the bifurcations at which their branches begin or end."""
    input:
        attractors=rules.attractors.output.attractors,
        refined=rules.attractors.output.refined,
    output:
        f"{RESULTS}/bifurcations/{{law}}.nc",
    log:
        f"{RESULTS}/logs/bifurcations/{{law}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/bifurcations/{{law}}.tsv"
    threads: shared_cores
    resources:
        mem_mb=memory(350),
        runtime=60,
        cpus_per_task=all_threads,
    params:
        config=uses("bifurcations_of_law", MODEL_OF_LAW, MOTION, "a", "attractors"),
        sources=sources("bifurcations_of_law"),
    message:
        "bifurcations of the branches of attractors, {wildcards.law} law"
    script:
        "../scripts/bifurcations_of_law.py"


rule edges_of_law:
    """Follow the boundaries between the basins of one friction law to edge states, and continue those in a."""
    input:
        attractors=rules.attractors.output.attractors,
        refined=rules.attractors.output.refined,
        returns=rules.attractors_of_law.output.returns,
        # Without bifurcations there are no crises.
        bifurcations=optional("bifurcations_of_law", rules.bifurcations_of_law.output),
    output:
        f"{RESULTS}/edges/{{law}}.nc",
    log:
        f"{RESULTS}/logs/edges/{{law}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/edges/{{law}}.tsv"
    threads: shared_cores
    resources:
        mem_mb=memory(350),
        runtime=240,
        cpus_per_task=all_threads,
    params:
        config=uses("edges_of_law", MODEL_OF_LAW, "edges", "attractors"),
        sources=sources("edges_of_law"),
    message:
        "edge states between the attractors of the {wildcards.law} law"
    script:
        "../scripts/edges_of_law.py"


rule edges:
    """Merge the edge states of all friction laws."""
    input:
        edges=expand(rules.edges_of_law.output, law=STUDY.laws),
    output:
        f"{RESULTS}/summary/edges.nc",
        shown("edges.txt", "edge states in words", "Attractors"),
    log:
        f"{RESULTS}/logs/edges.log",
    benchmark:
        f"{RESULTS}/benchmarks/edges.tsv"
    params:
        config=uses("edges"),
        sources=sources("edges"),
    message:
        "edge states of all laws"
    script:
        "../scripts/edges.py"


rule bifurcations:
    """Merge the bifurcations of all friction laws."""
    input:
        bifurcations=expand(rules.bifurcations_of_law.output, law=STUDY.laws),
        edges=optional("edges", rules.edges.output[0]),
    output:
        f"{RESULTS}/summary/bifurcations.nc",
        shown("bifurcations.txt", "bifurcations in words", "Attractors"),
    log:
        f"{RESULTS}/logs/bifurcations.log",
    benchmark:
        f"{RESULTS}/benchmarks/bifurcations.tsv"
    params:
        config=uses("bifurcations"),
        sources=sources("bifurcations"),
    message:
        "bifurcations of all laws"
    script:
        "../scripts/bifurcations.py"
