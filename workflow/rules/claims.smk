# The verdict on each claim of the paper, from the summaries.


rule claims:
    """Judge every claim of the paper from the summaries."""
    input:
        summaries=read_by_judges,
    output:
        f"{RESULTS}/summary/claims.json",
        shown("claims.csv", "claims of the paper", "Claims", paper="all"),
        f"{RESULTS}/summary/claims.md",
    log:
        f"{RESULTS}/logs/claims.log",
    benchmark:
        f"{RESULTS}/benchmarks/claims.tsv"
    resources:
        mem_mb=1000,
    params:
        config=uses("claims", MODELS, "study", "start", "transient", "window", "initial", "motion"),
        sources=sources("claims"),
        # Another figure leaves the verdicts as they are.
        figures=figures_of_claims,
    message:
        "verdicts on the claims of the paper"
    script:
        "../scripts/claims.py"
