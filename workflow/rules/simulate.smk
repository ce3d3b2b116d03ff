# Points: one simulation for each friction law, initial state and value of a, or of several parameters. In a study over a
# each point is a job; in one over several parameters each chunk of consecutive points is a job.
RUNS = JOBS.rules["simulate"]


rule points:
    """Simulate all points: each friction law from each initial state at each a, or at each point of the grid."""
    input:
        output_paths(JOBS.existing.get("chunk", RUNS)),


rule simulate:
    """Simulate one point: one friction law from one initial state at one a, or at one point of the grid."""
    output:
        f"{RESULTS}/{RUNS.files[0]}",
    log:
        f"{RESULTS}/logs/{RUNS.log_name}.log",
    benchmark:
        f"{RESULTS}/benchmarks/{RUNS.log_name}.tsv"
    priority: 3
    group:
        fixed_group("points", RUNS.each)
    resources:
        mem_mb=150,
        runtime=10,
    params:
        command=lambda wildcards: STUDY.command(**wildcards),
        sources=source_fingerprint(*RUNS.sources),
    message:
        snakemake_message(RUNS.message)
    # A run that stopped at a limit is a result as well.
    shell:
        "{params.command} --out {output} > /dev/null 2> {log} || [ $? = 3 ]"


if "simulate_solver" in JOBS.existing:
    AGAIN = JOBS.existing["simulate_solver"]

    use rule simulate as simulate_solver with:
        """Repeat one point with another solver."""
        output:
            f"{RESULTS}/{AGAIN.files[0]}",
        log:
            f"{RESULTS}/logs/{AGAIN.log_name}.log",
        benchmark:
            f"{RESULTS}/benchmarks/{AGAIN.log_name}.tsv"
        wildcard_constraints:
            solver="|".join(SOLVERS),
        group:
            fixed_group("solver_points", AGAIN.each)
        resources:
            mem_mb=150,
            runtime=60,
        params:
            command=lambda wildcards: STUDY.command(**wildcards),
        message:
            snakemake_message(AGAIN.message)


if "chunk" in JOBS.existing:
    CHUNKS = JOBS.existing["chunk"]

    rule chunk:
        """Simulate the points of a chunk that are missing, damaged or out of date."""
        output:
            touch(f"{RESULTS}/{CHUNKS.files[0]}"),
        log:
            f"{RESULTS}/logs/{CHUNKS.log_name}.log",
        benchmark:
            f"{RESULTS}/benchmarks/{CHUNKS.log_name}.tsv"
        wildcard_constraints:
            chunk=r"\d+",
        priority: 3
        resources:
            mem_mb=250,
            runtime=120,
        params:
            config=JOBS.config(CHUNKS, {}),
            sources=source_fingerprint(ROOT / "workflow/scripts/chunk.py"),
        message:
            snakemake_message(CHUNKS.message)
        script:
            "../scripts/chunk.py"
