# Solvers: the points at a few values of a, repeated with every other solver of each law.

from dataclasses import asdict

from burridge_knopoff.running.settings import SOLVERS
from burridge_knopoff.study.study import solver_points

SOLVER_POINT = f"{RESULTS}/solvers/{{solver}}/{POINT_FILE}"
SOLVER_POINTS = solver_points(STUDY)


use rule simulate as simulate_solver with:
    """Simulate one point again with another solver."""
    output:
        SOLVER_POINT,
    log:
        f"{RESULTS}/logs/simulate_solver/{{solver}}/{OF_POINT}.log",
    benchmark:
        f"{RESULTS}/benchmarks/simulate_solver/{{solver}}/{OF_POINT}.tsv"
    wildcard_constraints:
        solver="|".join(SOLVERS),
    group:
        fixed_group("solver_points", SOLVER_POINTS)
    resources:
        mem_mb=150,
        runtime=60,
    params:
        command=lambda wildcards: STUDY.command(**wildcards),
    message:
        "simulate {wildcards.law} law by {wildcards.solver}, initial state {wildcards.initial}, a = {wildcards.a}"


rule solvers:
    """Compare independent solvers of the equations of motion."""
    input:
        points=[
            f"{RESULTS}/points/{POINT_FILE}".format(**point)
            for point in POINTS
            if point["a"] in STUDY.compared
        ],
        others=[SOLVER_POINT.format(**point) for point in SOLVER_POINTS],
    output:
        f"{SUMMARY}/solvers.nc",
    log:
        f"{RESULTS}/logs/solvers.log",
    benchmark:
        f"{RESULTS}/benchmarks/solvers.tsv"
    group:
        group("summaries")
    params:
        folder=lambda wildcards: RESULTS,
        points={**STUDY.points, "parameters": {"a": STUDY.compared}},
        of_points=POINT_SOURCES,
        others={
            solver: {
                law: asdict(STUDY.settings(law, solver))
                for law in STUDY.laws
                if solver in STUDY.other_solvers(law)
            }
            for solver in SOLVERS
        },
        step=STUDY.config["solvers"]["step"],
        sources=sources("solvers"),
        seals=seals,
    message:
        "independent solvers of the same equations"
    script:
        "../scripts/solvers.py"
