# Points: one simulation for each friction law, initial state and value of a, or of several parameters. A study of a has
# a job for each point; one of several parameters has a job for each stretch of points.
POINTS = all_points(STUDY)
POINT_FILE = STUDY.point_file
OF_POINT = POINT_FILE.removesuffix(".nc")
POINT_SOURCES = source_fingerprint("burridge_knopoff.dataset.point")


rule points:
    """Simulate all points: each friction law from each initial state at each a, or at each point of the grid."""
    input:
        [
            f"{RESULTS}/{STRETCH}".format(stretch=stretch)
            for stretch in stretches(STUDY)
        ]
        if STUDY.is_plane
        else [f"{RESULTS}/points/{POINT_FILE}".format(**point) for point in POINTS],


rule simulate:
    """Simulate one point: one friction law from one initial state at one a, or at one point of the grid."""
    output:
        f"{RESULTS}/points/{POINT_FILE}",
    log:
        f"{RESULTS}/logs/simulate/{OF_POINT}.log",
    benchmark:
        f"{RESULTS}/benchmarks/simulate/{OF_POINT}.tsv"
    priority: 3
    group:
        fixed_group("points", POINTS)
    resources:
        mem_mb=150,
        runtime=10,
    params:
        command=lambda wildcards: STUDY.command(**wildcards),
        sources=POINT_SOURCES,
    message:
        "simulate {wildcards.law} law, initial state {wildcards.initial}, "
        + ", ".join(f"{name} = {{wildcards.{name}}}" for name in STUDY.parameters)
    # A run that hit a limit is a result too.
    shell:
        "{params.command} --out {output} > /dev/null 2> {log} || [ $? = 3 ]"


if STUDY.is_plane:

    rule stretch:
        """Simulate the points of a stretch that are missing, damaged or out of date."""
        output:
            touch(f"{RESULTS}/{STRETCH}"),
        log:
            f"{RESULTS}/logs/stretch/{{stretch}}.log",
        benchmark:
            f"{RESULTS}/benchmarks/stretch/{{stretch}}.tsv"
        wildcard_constraints:
            stretch=r"\d+",
        priority: 3
        resources:
            mem_mb=250,
            runtime=120,
        params:
            folder=lambda wildcards: RESULTS,
            points=identity(canonical(STUDY.points)),
            sources=sources("stretch"),
        message:
            "simulate the points of stretch {wildcards.stretch}"
        script:
            "../scripts/stretch.py"
