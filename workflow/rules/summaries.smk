# Summaries of all points, and of the models without points: one netCDF file for each question.
POINTS = point_keys(STUDY)


rule runs:
    """Collect the scalars of all runs, each of which is checked and read once."""
    input:
        points=all_point_files,
    output:
        f"{RESULTS}/summary/runs.nc",
    log:
        f"{RESULTS}/logs/runs.log",
    benchmark:
        f"{RESULTS}/benchmarks/runs.tsv"
    priority: FIRST
    resources:
        runtime=30,
    params:
        config=uses("runs", POINTS, "motion.period_tolerance", "motion.longest_period", "synchronization_threshold"),
        sources=sources("runs"),
    message:
        "summary: runs"
    script:
        "../scripts/runs.py"


rule mean_distance:
    """Compare the mean distance J between the end blocks with the threshold of synchrony."""
    input:
        runs=f"{RESULTS}/summary/runs.nc",
    output:
        f"{RESULTS}/summary/mean_distance.nc",
    log:
        f"{RESULTS}/logs/mean_distance.log",
    benchmark:
        f"{RESULTS}/benchmarks/mean_distance.tsv"
    priority: FIRST
    resources:
        runtime=30,
    params:
        config=uses("mean_distance", "synchronization_threshold"),
        sources=sources("mean_distance"),
    message:
        "summary: mean_distance"
    script:
        "../scripts/mean_distance.py"


rule bifurcation_diagram:
    """Collect the section points of all runs for the bifurcation diagrams."""
    input:
        points=all_point_files,
    output:
        f"{RESULTS}/summary/bifurcation_diagram.nc",
    log:
        f"{RESULTS}/logs/bifurcation_diagram.log",
    benchmark:
        f"{RESULTS}/benchmarks/bifurcation_diagram.tsv"
    priority: FIRST
    resources:
        mem_mb=1000,
        runtime=30,
    params:
        config=uses("bifurcation_diagram", POINTS),
        sources=sources("bifurcation_diagram"),
    message:
        "summary: bifurcation_diagram"
    script:
        "../scripts/bifurcation_diagram.py"


rule lyapunov:
    """Determine the kind of motion of each run from its Lyapunov exponents."""
    input:
        runs=f"{RESULTS}/summary/runs.nc",
    output:
        f"{RESULTS}/summary/lyapunov.nc",
    log:
        f"{RESULTS}/logs/lyapunov.log",
    benchmark:
        f"{RESULTS}/benchmarks/lyapunov.tsv"
    resources:
        runtime=30,
    params:
        config=uses("lyapunov", MOTION),
        sources=sources("lyapunov"),
    message:
        "summary: lyapunov"
    script:
        "../scripts/lyapunov.py"


rule stick_slip:
    """Measure the stick-slip cycles of each block in each run."""
    input:
        points=all_point_files,
    output:
        f"{RESULTS}/summary/stick_slip.nc",
    log:
        f"{RESULTS}/logs/stick_slip.log",
    benchmark:
        f"{RESULTS}/benchmarks/stick_slip.tsv"
    resources:
        runtime=30,
    params:
        config=uses("stick_slip", POINTS),
        sources=sources("stick_slip"),
    message:
        "summary: stick_slip"
    script:
        "../scripts/stick_slip.py"


rule agreement:
    """Determine where each friction law agrees with the first."""
    input:
        points=all_point_files,
        runs=f"{RESULTS}/summary/runs.nc",
        lyapunov=f"{RESULTS}/summary/lyapunov.nc",
        attractors=optional("attractors", f"{RESULTS}/summary/attractors.nc"),
    output:
        f"{RESULTS}/summary/agreement.nc",
        shown("agreement.csv", "table of the agreement", "Friction laws"),
        shown("agreement.txt", "agreement in words", "Friction laws"),
    log:
        f"{RESULTS}/logs/agreement.log",
    benchmark:
        f"{RESULTS}/benchmarks/agreement.tsv"
    resources:
        runtime=30,
    params:
        config=uses("agreement", POINTS, "synchronization_threshold", "agreement"),
        sources=sources("agreement"),
    message:
        "summary: agreement"
    script:
        "../scripts/agreement.py"


rule orbits:
    """Continue the synchronized orbit in a to its loss of stability, and the orbit that branches off there."""
    output:
        f"{RESULTS}/summary/orbits.nc",
    log:
        f"{RESULTS}/logs/orbits.log",
    benchmark:
        f"{RESULTS}/benchmarks/orbits.tsv"
    priority: FIRST
    resources:
        runtime=30,
    params:
        config=uses("orbits", MODELS, "a"),
        sources=sources("orbits"),
    message:
        "summary: orbits"
    script:
        "../scripts/orbits.py"


rule equilibrium:
    """Find uniform sliding and the eigenvalues of its perturbations."""
    output:
        f"{RESULTS}/summary/equilibrium.nc",
    log:
        f"{RESULTS}/logs/equilibrium.log",
    benchmark:
        f"{RESULTS}/benchmarks/equilibrium.tsv"
    resources:
        runtime=30,
    params:
        config=uses("equilibrium", MODELS, "a"),
        sources=sources("equilibrium"),
    message:
        "summary: equilibrium"
    script:
        "../scripts/equilibrium.py"
