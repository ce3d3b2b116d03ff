# Catalogues of slip events: a run for each law and a, and the statistics of their events.
from burridge_knopoff.study.params import catalogue_keys, catalogue_run

CATALOGUE = STUDY.config["catalogue"]


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
        model=lambda wildcards: model_config(STUDY, [wildcards.law]),
        blocks=STUDY.blocks,
        a=lambda wildcards: STUDY.value(wildcards.a),
        state={
            "name": CATALOGUE["initial"],
            **STUDY.config["initial"][CATALOGUE["initial"]],
        },
        run=lambda wildcards: catalogue_run(STUDY, wildcards.law),
        catalogue=catalogue_keys(STUDY),
        sources=sources("catalogue_of_run"),
        seals=seals,
    message:
        "slip events, {wildcards.law} law, a = {wildcards.a}"
    script:
        "../scripts/catalogue_of_run.py"


rule catalogue:
    """Count the slip events by magnitude and fit the slope, and measure extents, intervals and recurrence."""
    input:
        expand(rules.catalogue_of_run.output, law=STUDY.laws, a=STUDY.catalogue_a),
    output:
        f"{SUMMARY}/catalogue.nc",
    log:
        f"{RESULTS}/logs/catalogue.log",
    benchmark:
        f"{RESULTS}/benchmarks/catalogue.tsv"
    group:
        group("summaries")
    resources:
        mem_mb=1000,
    params:
        laws=list(STUDY.laws),
        grid=CATALOGUE["a"],
        fit={key: CATALOGUE[key] for key in ("low", "high") if key in CATALOGUE},
        sources=sources("catalogue"),
        seals=seals,
    message:
        "statistics of slip events, all laws"
    script:
        "../scripts/catalogue.py"
