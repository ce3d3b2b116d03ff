# Edges: where each branch of attractors begins, ends or changes, and by what.


rule edges:
    input:
        attractors=f"{SUMMARY}/attractors.nc",
        refined=f"{SUMMARY}/refined.nc",
    output:
        f"{SUMMARY}/edges.nc",
    log:
        f"{RESULTS}/logs/edges.log",
    benchmark:
        f"{RESULTS}/benchmarks/edges.tsv"
    resources:
        mem_mb=400,
        runtime=60,
    params:
        model=model_config(),
        blocks=STUDY.blocks,
        a=min(STUDY.grid.values()),
        sources=sources("edges", "summaries.edges"),
    message:
        "edges of all branches of attractors"
    script:
        "../scripts/edges.py"
