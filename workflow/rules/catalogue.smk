# Catalogues of slip events: one run for each law and a, and the statistics of the events.


rule catalogue_of_run:
    """Record the slip events of one run."""
    output:
        f"{RESULTS}/catalogues/{{law}}/a{{a}}.nc",
    log:
        f"{RESULTS}/logs/catalogues/{{law}}/a{{a}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/catalogues/{{law}}/a{{a}}.tsv"
    # Long runs start first.
    priority: 1
    resources:
        mem_mb=1000,
        runtime=240,
    params:
        config=uses("catalogue_of_run", MODEL_OF_LAW, "a={a}", catalogue_keys),
        sources=sources("catalogue_of_run"),
    message:
        "slip events, {wildcards.law} law, a = {wildcards.a}"
    script:
        "../scripts/catalogue_of_run.py"


rule catalogue:
    """Count the slip events by magnitude, fit the slope, and measure extents, intervals and recurrence."""
    input:
        catalogues=made("catalogue_of_run"),
    output:
        f"{RESULTS}/summary/catalogue.nc",
    log:
        f"{RESULTS}/logs/catalogue.log",
    benchmark:
        f"{RESULTS}/benchmarks/catalogue.tsv"
    resources:
        mem_mb=1000,
    params:
        config=uses(
            "catalogue",
            "laws",
            [f"catalogue.{name}" for name in ("a", "low", "high") if name in STUDY.config.get("catalogue", {})],
        ),
        sources=sources("catalogue"),
    message:
        "statistics of slip events, all laws"
    script:
        "../scripts/catalogue.py"
