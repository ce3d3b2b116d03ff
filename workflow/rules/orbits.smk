# Stability: what the equations of motion say without a point file.


rule orbits:
    output:
        f"{SUMMARY}/orbits.nc",
    log:
        f"{RESULTS}/logs/orbits.log",
    benchmark:
        f"{RESULTS}/benchmarks/orbits.tsv"
    resources:
        mem_mb=400,
        runtime=30,
    params:
        blocks=STUDY.blocks,
        model=model_config(),
        grid=list(STUDY.grid.values()),
        sources=script_sources("orbits"),
    message:
        "the synchronized orbit and where it is lost"
    script:
        "../scripts/orbits.py"
