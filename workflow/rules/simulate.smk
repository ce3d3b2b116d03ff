# Points: one simulation for each friction law, initial state and a.

POINTS = all_points(STUDY)
POINT_SOURCES = source_fingerprint("burridge_knopoff.dataset.point")


rule points:
    """Simulate all points: each friction law from each initial state at each a."""
    input:
        [f"{RESULTS}/points/{POINT}".format(**point) for point in POINTS],


rule simulate:
    """Simulate one point: one friction law from one initial state at one a."""
    output:
        f"{RESULTS}/points/{POINT}",
    log:
        f"{RESULTS}/logs/simulate/{{law}}/{{initial}}/a{{a}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/simulate/{{law}}/{{initial}}/a{{a}}.tsv"
    priority: 3
    group:
        fixed_group("points", POINTS)
    resources:
        mem_mb=150,
        runtime=10,
    params:
        command=lambda wildcards: STUDY.command(
            wildcards.law, wildcards.initial, wildcards.a
        ),
        sources=POINT_SOURCES,
    message:
        "simulate {wildcards.law} law, initial state {wildcards.initial}, a = {wildcards.a}"
    # A run that hit a limit is a result too.
    shell:
        "{params.command} --out {output} > /dev/null 2> {log} || [ $? = 3 ]"
