# Edges: where each branch of attractors begins, ends or changes, and by what; for each law, then put together.


rule edges_of_law:
    """Continue the periodic orbits of one friction law in a to the bifurcations where their branches begin or end."""
    input:
        attractors=f"{SUMMARY}/attractors.nc",
        refined=f"{SUMMARY}/refined.nc",
    output:
        f"{RESULTS}/edges/{{law}}.nc",
    log:
        f"{RESULTS}/logs/edges/{{law}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/edges/{{law}}.tsv"
    threads: SHARED_CORES
    resources:
        cpus_per_task=lambda wildcards, threads: threads,
        mem_mb=lambda wildcards, threads: 350 + 100 * threads,
        runtime=60,
    params:
        model=lambda wildcards: model_config([wildcards.law]),
        blocks=STUDY.blocks,
        a=min(STUDY.grid.values()),
        sources=sources("edges_of_law"),
        seals=seals,
        kept=lambda wildcards: kept_folder(
            f"edges {wildcards.law}",
            model_config([wildcards.law]),
            source_fingerprint("burridge_knopoff.summaries.edge_entries"),
        ),
    message:
        "edges of the branches of attractors, {wildcards.law} law"
    script:
        "../scripts/edges_of_law.py"


rule edges:
    """Put the bifurcations of all friction laws together."""
    input:
        expand(rules.edges_of_law.output, law=STUDY.laws),
    output:
        f"{SUMMARY}/edges.nc",
        report(
            f"{SUMMARY}/edges.txt",
            caption="../report/edges_text.rst",
            category="Attractors",
            labels={"result": "edges in words", "paper": "none"},
        ),
    log:
        f"{RESULTS}/logs/edges.log",
    benchmark:
        f"{RESULTS}/benchmarks/edges.tsv"
    group:
        group("summaries")
    params:
        summary="edges",
        sources=sources("merge", "summaries.edges"),
        seals=seals,
    message:
        "edges of all laws"
    script:
        "../scripts/merge.py"
