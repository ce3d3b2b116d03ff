# Figures: each as PDF for print and PNG for the screen.

FIGURES = f"{RESULTS}/figures"
FORMATS = ("pdf", "png")
FIGURE_POINTS = {
    initial: POINT.format(
        law=STUDY.config["figures"]["law"], initial=initial, a=STUDY.figure_point
    )
    for initial in STUDY.initial
}


rule figures:
    input:
        expand(
            f"{FIGURES}/{{name}}.{{format}}",
            name=[
                "friction_laws",
                "mean_distance",
                "bifurcation",
                "distance",
                "lyapunov",
                "agreement",
                "basin_fractions",
                *(["basins"] if BASIN_MAPS else []),
                "orbits",
                *(f"motion_{initial}" for initial in STUDY.initial),
            ],
            format=FORMATS,
        ),


rule figure_friction_laws:
    output:
        multiext(f"{FIGURES}/friction_laws", ".pdf", ".png"),
    log:
        f"{RESULTS}/logs/figure_friction_laws.log",
    benchmark:
        f"{RESULTS}/benchmarks/figure_friction_laws.tsv"
    params:
        a=STUDY.grid[STUDY.figure_point],
        largest=max(STUDY.grid.values()),
    message:
        "figure: friction laws"
    script:
        "../scripts/figure_friction_laws.py"


rule figure_mean_distance:
    input:
        rules.mean_distance.output,
        rules.attractors.output.dataset,
    output:
        multiext(f"{FIGURES}/mean_distance", ".pdf", ".png"),
    log:
        f"{RESULTS}/logs/figure_mean_distance.log",
    benchmark:
        f"{RESULTS}/benchmarks/figure_mean_distance.tsv"
    message:
        "figure: <J> against a"
    script:
        "../scripts/figure_mean_distance.py"


rule figure_bifurcation:
    input:
        rules.bifurcation.output,
    output:
        multiext(f"{FIGURES}/bifurcation", ".pdf", ".png"),
    log:
        f"{RESULTS}/logs/figure_bifurcation.log",
    benchmark:
        f"{RESULTS}/benchmarks/figure_bifurcation.tsv"
    message:
        "figure: bifurcation diagrams"
    script:
        "../scripts/figure_bifurcation.py"


rule figure_distance:
    input:
        **FIGURE_POINTS,
    output:
        multiext(f"{FIGURES}/distance", ".pdf", ".png"),
    log:
        f"{RESULTS}/logs/figure_distance.log",
    benchmark:
        f"{RESULTS}/benchmarks/figure_distance.tsv"
    message:
        "figure: J against time"
    script:
        "../scripts/figure_distance.py"


rule figure_motion:
    input:
        lambda wildcards: FIGURE_POINTS[wildcards.initial],
    output:
        multiext(f"{FIGURES}/motion_{{initial}}", ".pdf", ".png"),
    log:
        f"{RESULTS}/logs/figure_motion_{{initial}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/figure_motion_{{initial}}.tsv"
    message:
        "figure: velocities and positions, initial state {wildcards.initial}"
    script:
        "../scripts/figure_motion.py"


rule figure_lyapunov:
    input:
        rules.lyapunov.output,
    output:
        multiext(f"{FIGURES}/lyapunov", ".pdf", ".png"),
    log:
        f"{RESULTS}/logs/figure_lyapunov.log",
    benchmark:
        f"{RESULTS}/benchmarks/figure_lyapunov.tsv"
    message:
        "figure: Lyapunov exponents against a"
    script:
        "../scripts/figure_lyapunov.py"


rule figure_basin_fractions:
    input:
        rules.attractors.output.dataset,
    output:
        multiext(f"{FIGURES}/basin_fractions", ".pdf", ".png"),
    log:
        f"{RESULTS}/logs/figure_basin_fractions.log",
    benchmark:
        f"{RESULTS}/benchmarks/figure_basin_fractions.tsv"
    message:
        "figure: basin fractions and sweeps of a"
    script:
        "../scripts/figure_basin_fractions.py"


rule figure_basins:
    input:
        rules.basins.output.dataset,
        rules.attractors.output.dataset,
    output:
        multiext(f"{FIGURES}/basins", ".pdf", ".png"),
    log:
        f"{RESULTS}/logs/figure_basins.log",
    benchmark:
        f"{RESULTS}/benchmarks/figure_basins.tsv"
    params:
        marked=STUDY.marked_states,
    message:
        "figure: maps of basins"
    script:
        "../scripts/figure_basins.py"


rule figure_agreement:
    input:
        rules.agreement.output.dataset,
    output:
        multiext(f"{FIGURES}/agreement", ".pdf", ".png"),
    log:
        f"{RESULTS}/logs/figure_agreement.log",
    benchmark:
        f"{RESULTS}/benchmarks/figure_agreement.tsv"
    message:
        "figure: agreement of the two laws"
    script:
        "../scripts/figure_agreement.py"


rule figure_orbits:
    input:
        orbits=rules.orbits.output[0],
        runs=rules.mean_distance.output[0],
    output:
        multiext(f"{FIGURES}/orbits", ".pdf", ".png"),
    log:
        f"{RESULTS}/logs/figure_orbits.log",
    benchmark:
        f"{RESULTS}/benchmarks/figure_orbits.tsv"
    message:
        "figure: the synchronized orbit and where it is lost"
    script:
        "../scripts/figure_orbits.py"
