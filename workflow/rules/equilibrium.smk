# Uniform sliding: like the orbits, from the equations of motion without a point file.


rule equilibrium:
    output:
        f"{SUMMARY}/equilibrium.nc",
    log:
        f"{RESULTS}/logs/equilibrium.log",
    benchmark:
        f"{RESULTS}/benchmarks/equilibrium.tsv"
    resources:
        mem_mb=400,
        runtime=30,
    params:
        blocks=STUDY.blocks,
        model=model_config(),
        grid=list(STUDY.grid.values()),
        sources=script_sources("equilibrium"),
    message:
        "uniform sliding and the growth of its perturbations"
    script:
        "../scripts/equilibrium.py"
