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
        grid=list(STUDY.grid.values()),
        initial=STUDY.config["initial"],
        model=lambda wildcards: model_config([wildcards.law]),
        start=STUDY.config["start"],
        attractors=STUDY.config["attractors"],
        motion=motion_config(),
        sources=script_sources("attractors_of_law"),
    message:
        "attractors of the {wildcards.law} law along a"
    script:
        "../scripts/attractors_of_law.py"


rule attractors:
    input:
        expand(rules.attractors_of_law.output, law=STUDY.laws),
    output:
        dataset=f"{SUMMARY}/attractors.nc",
        digest=report(
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
        sources=script_sources("attractors"),
    message:
        "attractors of all laws"
    script:
        "../scripts/attractors.py"
