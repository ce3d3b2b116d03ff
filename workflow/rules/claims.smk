# Claims: each statement of the paper judged by the summaries.


rule claims:
    input:
        summaries=[
            f"{SUMMARY}/{name}.nc"
            for name in (
                "mean_distance",
                "bifurcation",
                "lyapunov",
                "agreement",
                "attractors",
                "orbits",
                "stick_slip",
                "equilibrium",
                "solvers",
                *([] if SINGLE_LENGTH else ["two_blocks"]),
            )
        ],
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
    resources:
        mem_mb=1000,
        runtime=10,
    params:
        study=STUDY.name,
        claims=CLAIMS,
        config={
            key: STUDY.config[key]
            for key in (
                *("v", "contact", "start", "transient", "window", "initial", "motion"),
                *("laws", "chain"),
            )
        },
        figures=FIGURE_NAMES,
        sources=script_sources("claims"),
    message:
        "verdicts on the claims of the paper"
    script:
        "../scripts/claims.py"
