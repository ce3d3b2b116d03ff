# Points: one simulation for each friction law, initial state and value of a, or of several parameters. In a study over a
# each point is a job; in one over several parameters each chunk of consecutive points is a job. A point takes less time than
# a start of Python: it is simulated in a thread of Snakemake, on a cluster in a process of its own.
POINT = STUDY.point_file.removesuffix(".nc")
GRID = {
    "law": STUDY.laws,
    "initial": STUDY.initial,
    **{word: list(STUDY.parameters[name]) for word, name in STUDY.wildcards.items()},
}
STOP = stop_on_interrupt()


rule simulate:
    """Simulate one point: one friction law from one initial state at one a, or at one point of the grid."""
    output:
        f"{RESULTS}/points/{POINT}.nc",
    log:
        f"{RESULTS}/logs/simulate/{POINT}.log",
    priority: 3
    group:
        "points"
    resources:
        mem_mb=150,
        runtime=10,
    params:
        command=simulates("simulate"),
        sources=source_fingerprint("burridge_knopoff.dataset.point"),
    message:
        "simulate {wildcards.law} law, initial state {wildcards.initial}, "
        + ", ".join(f"{name} = {{wildcards.{word}}}" for word, name in STUDY.wildcards.items())
    run:
        if workflow.remote_exec:
            # A cluster ends a job by signals, which the thread of a run does not see.
            run_point_command(f"{params.command} --out {output}", output[0], log[0], RESULTS)
        else:
            run_point_job(STUDY, wildcards, output[0], log[0], RESULTS, STOP)


internals.run_in_thread(rules.simulate, "{params.command} --out {output}")


rule chunk:
    """Simulate the points of a chunk that are missing, corrupt or out of date."""
    output:
        touch(f"{RESULTS}/chunks/{{chunk}}.done"),
    log:
        f"{RESULTS}/logs/chunk/{{chunk}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/chunk/{{chunk}}.tsv"
    wildcard_constraints:
        chunk=r"\d+",
    priority: 3
    resources:
        mem_mb=250,
        runtime=120,
    params:
        config=uses("chunk", point_keys(STUDY)),
        sources=sources("chunk"),
    message:
        "simulate the points of chunk {wildcards.chunk}"
    script:
        "../scripts/chunk.py"
