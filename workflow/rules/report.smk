# Report: one HTML file that opens offline, with the verdicts, charts, figures and commands of the study.
import hashlib

# Results of the optional stage are not inputs, since the report must not make them. It shows existing ones.
OPTIONAL_RESULTS = {
    path: hashlib.sha256(Path(path).read_bytes()).hexdigest()
    for path in (f"{SUMMARY}/chains.nc", f"{FIGURES}/chains.png")
    if Path(path).is_file()
}


rule report:
    """Write the report of the study, one HTML file that opens offline."""
    input:
        claims=CLAIMS_MADE[:1],
        summaries=[path for path in rules.summary.input if path.endswith(".nc")],
        figures=[path for path in rules.figures.input if path.endswith(".png")],
    output:
        f"{RESULTS}/report.html",
    log:
        f"{RESULTS}/logs/report.log",
    benchmark:
        f"{RESULTS}/benchmarks/report.tsv"
    group:
        group("figures")
    resources:
        mem_mb=600,
        runtime=10,
    params:
        # The report shows the whole config.
        config=STUDY.config,
        parameters=STUDY.points["parameters"],
        arguments=CONFIG_ARGUMENTS,
        optional=OPTIONAL_RESULTS,
        benchmarks=f"{RESULTS}/benchmarks",
        sources=sources("report"),
        seals=seals,
    message:
        f"report: {RESULTS}/report.html"
    script:
        "../scripts/report.py"
