# Summaries: from all points to one netCDF file a question.

SUMMARY = f"{RESULTS}/summary"


rule summary:
    input:
        f"{SUMMARY}/mean_distance.nc",
        f"{SUMMARY}/bifurcation.nc",
        f"{SUMMARY}/lyapunov.nc",
        f"{SUMMARY}/attractors.nc",
        f"{SUMMARY}/attractors.txt",
        [f"{SUMMARY}/basins.nc", f"{SUMMARY}/basins.txt"]
        if any(STUDY.config["basins"]["a"].values())
        else [],
        f"{SUMMARY}/agreement.nc",
        f"{SUMMARY}/agreement.csv",
        f"{SUMMARY}/agreement.txt",
        f"{SUMMARY}/orbits.nc",
        f"{SUMMARY}/stick_slip.nc",
        f"{SUMMARY}/equilibrium.nc",
        f"{SUMMARY}/solvers.nc",
        [] if SINGLE_LENGTH else f"{SUMMARY}/two_blocks.nc",
        multiext(f"{SUMMARY}/claims", ".json", ".csv", ".md"),


rule mean_distance:
    input:
        rules.points.input,
    output:
        f"{SUMMARY}/mean_distance.nc",
    log:
        f"{RESULTS}/logs/mean_distance.log",
    benchmark:
        f"{RESULTS}/benchmarks/mean_distance.tsv"
    resources:
        mem_mb=400,
        runtime=30,
    params:
        points=STUDY.points,
        threshold=STUDY.config["synchronization_threshold"],
        sources=script_sources("mean_distance"),
    message:
        "<J> over law, initial state and a"
    script:
        "../scripts/mean_distance.py"


rule bifurcation:
    input:
        rules.points.input,
    output:
        f"{SUMMARY}/bifurcation.nc",
    log:
        f"{RESULTS}/logs/bifurcation.log",
    benchmark:
        f"{RESULTS}/benchmarks/bifurcation.tsv"
    resources:
        mem_mb=1000,
        runtime=30,
    params:
        points=STUDY.points,
        sources=script_sources("bifurcation"),
    message:
        "section points W' of all runs"
    script:
        "../scripts/bifurcation.py"


rule lyapunov:
    input:
        rules.points.input,
    output:
        f"{SUMMARY}/lyapunov.nc",
    log:
        f"{RESULTS}/logs/lyapunov.log",
    benchmark:
        f"{RESULTS}/benchmarks/lyapunov.tsv"
    resources:
        mem_mb=400,
        runtime=30,
    params:
        points=STUDY.points,
        exponents=STUDY.config["lyapunov_exponents"],
        threshold=STUDY.config["synchronization_threshold"],
        motion=STUDY.config["motion"],
        sources=script_sources("lyapunov"),
    message:
        "Lyapunov exponents and kinds of motion"
    script:
        "../scripts/lyapunov.py"


rule agreement:
    input:
        points=rules.points.input,
        lyapunov=rules.lyapunov.output,
    output:
        dataset=f"{SUMMARY}/agreement.nc",
        table=report(
            f"{SUMMARY}/agreement.csv",
            caption="../report/agreement_table.rst",
            category="Friction laws",
            labels={"result": "table of the agreement", "paper": "none"},
        ),
        digest=report(
            f"{SUMMARY}/agreement.txt",
            caption="../report/agreement_text.rst",
            category="Friction laws",
            labels={"result": "agreement in words", "paper": "none"},
        ),
    log:
        f"{RESULTS}/logs/agreement.log",
    benchmark:
        f"{RESULTS}/benchmarks/agreement.tsv"
    resources:
        mem_mb=400,
        runtime=30,
    params:
        points=STUDY.points,
        threshold=STUDY.config["synchronization_threshold"],
        agreement=STUDY.config["agreement"],
        sources=script_sources("agreement"),
    message:
        "agreement of the friction laws"
    script:
        "../scripts/agreement.py"


rule stick_slip:
    input:
        rules.points.input,
    output:
        f"{SUMMARY}/stick_slip.nc",
    log:
        f"{RESULTS}/logs/stick_slip.log",
    benchmark:
        f"{RESULTS}/benchmarks/stick_slip.tsv"
    resources:
        mem_mb=400,
        runtime=30,
    params:
        points=STUDY.points,
        blocks=STUDY.blocks,
        window={key: STUDY.config[key] for key in ("transient", "window", "batches")},
        sources=script_sources("stick_slip"),
    message:
        "stick-slip cycles of each block"
    script:
        "../scripts/stick_slip.py"
