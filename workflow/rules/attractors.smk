# Attractors: found for each law along the whole grid of a, then put together.


rule attractors_of_law:
    output:
        f"{RESULTS}/attractors/{{law}}.nc",
    log:
        f"{RESULTS}/logs/attractors/{{law}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/attractors/{{law}}.tsv"
    # The longest jobs of a study: begun first, so that none is left alone at its end.
    priority: 10
    resources:
        mem_mb=400,
        runtime=240,
    params:
        **keys("initial", "start", "attractors"),
        grid=list(STUDY.grid.values()),
        model=lambda wildcards: model_config([wildcards.law]),
        motion=motion_config(),
        sources=sources("attractors_of_law"),
    message:
        "attractors of the {wildcards.law} law along a"
    script:
        "../scripts/attractors_of_law.py"


rule attractors:
    input:
        expand(rules.attractors_of_law.output, law=STUDY.laws),
    output:
        f"{SUMMARY}/attractors.nc",
        report(
            f"{SUMMARY}/attractors.txt",
            caption="../report/attractors_text.rst",
            category="Attractors",
            labels={"result": "attractors in words", "paper": "none"},
        ),
    log:
        f"{RESULTS}/logs/attractors.log",
    benchmark:
        f"{RESULTS}/benchmarks/attractors.tsv"
    resources:
        mem_mb=400,
        runtime=10,
    params:
        summary="attractors",
        sources=sources("merge", "summaries.attractors"),
    message:
        "attractors of all laws"
    script:
        "../scripts/merge.py"
