# Figures: each as PDF for print and PNG for the screen.

FIGURES = f"{RESULTS}/figures"
FORMATS = ("pdf", "png")
FIGURE_POINTS = {
    initial: POINT.format(
        law=STUDY.config["figures"]["law"], initial=initial, a=STUDY.figure_point
    )
    for initial in STUDY.initial
}
# Of the points only these are read.
FIGURE_RUNS = {
    "points": {
        **STUDY.points,
        "a": {STUDY.figure_point: STUDY.grid[STUDY.figure_point]},
    },
    "law": STUDY.config["figures"]["law"],
    "a": STUDY.figure_point,
}


MIRROR_SYMMETRIC = STUDY.model(
    STUDY.laws[0], STUDY.grid[STUDY.figure_point]
).chain.is_mirror_symmetric
FIGURE_NAMES = [
    "friction_laws",
    "mean_distance",
    "bifurcation",
    "distance",
    "lyapunov",
    # With one law there is nothing to compare.
    *(["agreement"] if len(STUDY.laws) > 1 else []),
    "basin_fractions",
    *(["basins"] if BASIN_MAPS else []),
    # The orbit of three blocks, the last the mirror image of the first; of other chains there is none.
    *(["orbits"] if STUDY.blocks == 3 and MIRROR_SYMMETRIC else []),
    "stick_slip",
    "equilibrium",
    "solvers",
    *([] if SINGLE_LENGTH else ["two_blocks"]),
    *(f"motion_{initial}" for initial in STUDY.initial),
]


rule figures:
    input:
        expand(f"{FIGURES}/{{name}}.{{format}}", name=FIGURE_NAMES, format=FORMATS),


rule figure_friction_laws:
    input:
        rules.mean_distance.output,
    output:
        f"{FIGURES}/friction_laws.pdf",
        report(
            f"{FIGURES}/friction_laws.png",
            caption="../report/friction_laws.rst",
            category="Model",
            labels={"result": "friction laws", "paper": "Fig. 2"},
        ),
    log:
        f"{RESULTS}/logs/figure_friction_laws.log",
    benchmark:
        f"{RESULTS}/benchmarks/figure_friction_laws.tsv"
    params:
        laws=STUDY.config["laws"],
        a=STUDY.grid[STUDY.figure_point],
        largest=max(STUDY.grid.values()),
        sources=script_sources("figure_friction_laws"),
    message:
        "figure: friction laws, and the least friction in the runs"
    script:
        "../scripts/figure_friction_laws.py"


rule figure_mean_distance:
    input:
        rules.mean_distance.output,
        rules.attractors.output.dataset,
    output:
        f"{FIGURES}/mean_distance.pdf",
        report(
            f"{FIGURES}/mean_distance.png",
            caption="../report/mean_distance.rst",
            category="Synchronization",
            labels={"result": "⟨J⟩ against a", "paper": "Figs. 3a, 3b"},
        ),
    log:
        f"{RESULTS}/logs/figure_mean_distance.log",
    benchmark:
        f"{RESULTS}/benchmarks/figure_mean_distance.tsv"
    params:
        sources=script_sources("figure_mean_distance"),
    message:
        "figure: <J> against a"
    script:
        "../scripts/figure_mean_distance.py"


rule figure_bifurcation:
    input:
        rules.bifurcation.output,
    output:
        f"{FIGURES}/bifurcation.pdf",
        report(
            f"{FIGURES}/bifurcation.png",
            caption="../report/bifurcation.rst",
            category="Synchronization",
            labels={"result": "bifurcation diagrams", "paper": "Figs. 4a, 4b"},
        ),
    log:
        f"{RESULTS}/logs/figure_bifurcation.log",
    benchmark:
        f"{RESULTS}/benchmarks/figure_bifurcation.tsv"
    params:
        sources=script_sources("figure_bifurcation"),
    message:
        "figure: bifurcation diagrams"
    script:
        "../scripts/figure_bifurcation.py"


rule figure_distance:
    input:
        **FIGURE_POINTS,
    output:
        f"{FIGURES}/distance.pdf",
        report(
            f"{FIGURES}/distance.png",
            caption="../report/distance.rst",
            category="Runs",
            labels={"result": "J against time", "paper": "Figs. 5a, 5b"},
        ),
    log:
        f"{RESULTS}/logs/figure_distance.log",
    benchmark:
        f"{RESULTS}/benchmarks/figure_distance.tsv"
    params:
        **FIGURE_RUNS,
        sources=script_sources("figure_distance"),
    message:
        "figure: J against time"
    script:
        "../scripts/figure_distance.py"


rule figure_motion:
    input:
        lambda wildcards: FIGURE_POINTS[wildcards.initial],
    output:
        f"{FIGURES}/motion_{{initial}}.pdf",
        report(
            f"{FIGURES}/motion_{{initial}}.png",
            caption="../report/motion.rst",
            category="Runs",
            labels={
                "result": "velocities and positions, {initial}",
                "paper": "Figs. 6, 7",
            },
        ),
    log:
        f"{RESULTS}/logs/figure_motion_{{initial}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/figure_motion_{{initial}}.tsv"
    params:
        **FIGURE_RUNS,
        sources=script_sources("figure_motion"),
    message:
        "figure: velocities and positions, initial state {wildcards.initial}"
    script:
        "../scripts/figure_motion.py"


rule figure_lyapunov:
    input:
        rules.lyapunov.output,
    output:
        f"{FIGURES}/lyapunov.pdf",
        report(
            f"{FIGURES}/lyapunov.png",
            caption="../report/lyapunov.rst",
            category="Synchronization",
            labels={"result": "Lyapunov exponents", "paper": "none"},
        ),
    log:
        f"{RESULTS}/logs/figure_lyapunov.log",
    benchmark:
        f"{RESULTS}/benchmarks/figure_lyapunov.tsv"
    params:
        sources=script_sources("figure_lyapunov"),
    message:
        "figure: Lyapunov exponents against a"
    script:
        "../scripts/figure_lyapunov.py"


rule figure_basin_fractions:
    input:
        rules.attractors.output.dataset,
    output:
        f"{FIGURES}/basin_fractions.pdf",
        report(
            f"{FIGURES}/basin_fractions.png",
            caption="../report/basin_fractions.rst",
            category="Attractors",
            labels={"result": "basin fractions and sweeps of a", "paper": "none"},
        ),
    log:
        f"{RESULTS}/logs/figure_basin_fractions.log",
    benchmark:
        f"{RESULTS}/benchmarks/figure_basin_fractions.tsv"
    params:
        sources=script_sources("figure_basin_fractions"),
    message:
        "figure: basin fractions and sweeps of a"
    script:
        "../scripts/figure_basin_fractions.py"


rule figure_basins:
    input:
        rules.basins.output.dataset,
        rules.attractors.output.dataset,
    output:
        f"{FIGURES}/basins.pdf",
        report(
            f"{FIGURES}/basins.png",
            caption="../report/basins.rst",
            category="Attractors",
            labels={"result": "maps of basins", "paper": "none"},
        ),
    log:
        f"{RESULTS}/logs/figure_basins.log",
    benchmark:
        f"{RESULTS}/benchmarks/figure_basins.tsv"
    params:
        marked=STUDY.marked_states,
        sources=script_sources("figure_basins"),
    message:
        "figure: maps of basins"
    script:
        "../scripts/figure_basins.py"


rule figure_agreement:
    input:
        rules.agreement.output.dataset,
    output:
        f"{FIGURES}/agreement.pdf",
        report(
            f"{FIGURES}/agreement.png",
            caption="../report/agreement.rst",
            category="Friction laws",
            labels={"result": "agreement of the laws", "paper": "none"},
        ),
    log:
        f"{RESULTS}/logs/figure_agreement.log",
    benchmark:
        f"{RESULTS}/benchmarks/figure_agreement.tsv"
    params:
        sources=script_sources("figure_agreement"),
    message:
        "figure: agreement of the laws"
    script:
        "../scripts/figure_agreement.py"


rule figure_orbits:
    input:
        orbits=rules.orbits.output[0],
        runs=rules.mean_distance.output[0],
    output:
        f"{FIGURES}/orbits.pdf",
        report(
            f"{FIGURES}/orbits.png",
            caption="../report/orbits.rst",
            category="Synchronization",
            labels={"result": "synchronized orbit", "paper": "none"},
        ),
    log:
        f"{RESULTS}/logs/figure_orbits.log",
    benchmark:
        f"{RESULTS}/benchmarks/figure_orbits.tsv"
    params:
        sources=script_sources("figure_orbits"),
    message:
        "figure: the synchronized orbit and where it is lost"
    script:
        "../scripts/figure_orbits.py"


rule figure_stick_slip:
    input:
        rules.stick_slip.output,
    output:
        f"{FIGURES}/stick_slip.pdf",
        report(
            f"{FIGURES}/stick_slip.png",
            caption="../report/stick_slip.rst",
            category="Runs",
            labels={"result": "stick-slip cycles", "paper": "none"},
        ),
    log:
        f"{RESULTS}/logs/figure_stick_slip.log",
    benchmark:
        f"{RESULTS}/benchmarks/figure_stick_slip.tsv"
    params:
        law=STUDY.config["figures"]["law"],
        sources=script_sources("figure_stick_slip"),
    message:
        "figure: stick-slip cycles against a"
    script:
        "../scripts/figure_stick_slip.py"


rule figure_equilibrium:
    input:
        rules.equilibrium.output,
    output:
        f"{FIGURES}/equilibrium.pdf",
        report(
            f"{FIGURES}/equilibrium.png",
            caption="../report/equilibrium.rst",
            category="Model",
            labels={"result": "uniform sliding", "paper": "none"},
        ),
    log:
        f"{RESULTS}/logs/figure_equilibrium.log",
    benchmark:
        f"{RESULTS}/benchmarks/figure_equilibrium.tsv"
    params:
        sources=script_sources("figure_equilibrium"),
    message:
        "figure: uniform sliding and the growth of its perturbations"
    script:
        "../scripts/figure_equilibrium.py"


rule figure_solvers:
    input:
        rules.solvers.output,
    output:
        f"{FIGURES}/solvers.pdf",
        report(
            f"{FIGURES}/solvers.png",
            caption="../report/solvers.rst",
            category="Friction laws",
            labels={"result": "independent solvers", "paper": "none"},
        ),
    log:
        f"{RESULTS}/logs/figure_solvers.log",
    benchmark:
        f"{RESULTS}/benchmarks/figure_solvers.tsv"
    params:
        sources=script_sources("figure_solvers"),
    message:
        "figure: independent solvers of the same equations"
    script:
        "../scripts/figure_solvers.py"
