# The report, one HTML file that opens offline.


rule report:
    """Write the report of the study, one HTML file that opens offline."""
    input:
        # The page draws the moving blocks of single runs.
        points=[] if STUDY.is_plane else all_point_files,
        claims=[file for file in SUMMARIES if file.endswith("claims.json")],
        summaries=[file for file in SUMMARIES if file.endswith(".nc")],
        figures=[file for file in FIGURES if file.endswith(".png")],
    output:
        f"{RESULTS}/report.html",
    log:
        f"{RESULTS}/logs/report.log",
    benchmark:
        f"{RESULTS}/benchmarks/report.tsv"
    resources:
        mem_mb=600,
    params:
        # The report shows the whole config.
        config=uses("report", *STUDY.config),
        sources=sources("report"),
        arguments=CONFIG_ARGUMENTS,
    message:
        f"report: {RESULTS}/report.html"
    script:
        "../scripts/report.py"
