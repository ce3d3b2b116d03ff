# The comparison of the solvers: points at a few values of a, repeated with every other solver of each law.


use rule simulate as simulate_solver with:
    """Repeat one point with another solver."""
    output:
        f"{RESULTS}/solvers/{{solver}}/{POINT}.nc",
    log:
        f"{RESULTS}/logs/simulate_solver/{{solver}}/{POINT}.log",
    wildcard_constraints:
        solver="|".join(SOLVERS),
    group:
        "solver_points"
    resources:
        mem_mb=150,
        runtime=60,
    params:
        command=simulates("simulate_solver"),
    message:
        "simulate {wildcards.law} law by {wildcards.solver}, initial state {wildcards.initial}, a = {wildcards.a}"


internals.run_in_thread(rules.simulate_solver, "{params.command} --out {output}")


rule solvers:
    """Compare independent solvers of the equations of motion."""
    input:
        points=lambda wildcards: point_files(a=STUDY.compared_values),
        other_points=made("simulate_solver"),
    output:
        f"{RESULTS}/summary/solvers.nc",
    log:
        f"{RESULTS}/logs/solvers.log",
    benchmark:
        f"{RESULTS}/benchmarks/solvers.tsv"
    params:
        config=uses("solvers", run_keys(STUDY), "initial", "solvers.a", "solvers.step"),
        sources=sources("solvers"),
    message:
        "independent solvers of the same equations"
    script:
        "../scripts/solvers.py"
