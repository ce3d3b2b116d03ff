# Claims: the verdict on each statement of the paper, from the summaries that judges read.
from burridge_knopoff.claims.evidence import READ_BY_JUDGES


rule claims:
    """Judge every claim of the paper from the summaries."""
    input:
        expand(
            f"{SUMMARY}/{{name}}.nc",
            name=[name for name in MADE if name in READ_BY_JUDGES],
        ),
    output:
        content=f"{SUMMARY}/claims.json",
        table=report(
            f"{SUMMARY}/claims.csv",
            caption="../report/claims.rst",
            category="Claims",
            labels={"result": "claims of the paper", "paper": "all"},
        ),
        text=f"{SUMMARY}/claims.md",
    log:
        f"{RESULTS}/logs/claims.log",
    benchmark:
        f"{RESULTS}/benchmarks/claims.tsv"
    group:
        group("summaries")
    resources:
        mem_mb=1000,
        runtime=10,
    params:
        study=STUDY.name,
        claims=CLAIMS,
        config=keys(
            STUDY,
            "v",
            "contact",
            "start",
            "transient",
            "window",
            "initial",
            "motion",
            "laws",
            "chain",
        ),
        figures=sorted({Path(path).stem for path in rules.figures.input}),
        sources=sources("claims"),
        seals=seals,
    message:
        "verdicts on the claims of the paper"
    script:
        "../scripts/claims.py"
