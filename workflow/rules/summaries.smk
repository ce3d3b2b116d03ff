# Summaries of points, and of models alone: one netCDF file a question, by the module of its name in `summaries`.
from burridge_knopoff.figures.description import figure_descriptions
from burridge_knopoff.study.stages import TEXTS

# Summaries in the figures of the paper come first.
OF_PAPER_FIGURES = {
    name for figure in figure_descriptions() if figure.paper for name in figure.inputs
}

# Purpose and inputs of a summary, other files that it reads, config keys that it uses, and texts: {suffix: result}.
SUMMARIES = {
    "mean_distance": {
        "docstring": "Average the distance J between the end blocks over each run.",
        "of": "points",
        "keys": ["synchronization_threshold"],
    },
    "bifurcation_diagram": {
        "docstring": "Collect the section points of all runs for the bifurcation diagrams.",
        "of": "points",
        "mem_mb": 1000,
    },
    "lyapunov": {
        "docstring": "Estimate the Lyapunov exponents of each run and tell its kind of motion.",
        "of": "points",
        "keys": ["lyapunov_exponents", "synchronization_threshold", "motion"],
    },
    "agreement": {
        "docstring": "Judge where each friction law agrees with the first one.",
        "of": "points",
        "summaries": ["lyapunov", "attractors"],
        "keys": ["synchronization_threshold", "agreement"],
        "texts": {"csv": "table of the agreement", "txt": "agreement in words"},
    },
    "stick_slip": {
        "docstring": "Measure the stick-slip cycles of each block in each run.",
        "of": "points",
        "keys": ["transient", "window", "batches"],
    },
    "orbits": {
        "docstring": "Follow the synchronized orbit in a to where it loses its stability, and the orbit that branches off there.",
        "of": "models",
    },
    "equilibrium": {
        "docstring": "Find uniform sliding and the eigenvalues of its perturbations.",
        "of": "models",
    },
    "grid": {
        "docstring": "Collect the numbers of all runs over the study's parameters.",
        "of": "points",
        "keys": ["lyapunov_exponents", "synchronization_threshold", "motion"],
    },
}
# Of these and of the stages' summaries, those that the study has.
MADE = [name for name in SUMMARIES if STUDY.has_summary(name)]
MADE += STUDY.stage_summaries
CLAIMS_MADE = (
    multiext(f"{SUMMARY}/claims", ".json", ".csv", ".md")
    if "claims" in STUDY.stages
    else []
)
SUMMARY_FILES = {"points": {"points": rules.points.input}, "models": {}}
SUMMARY_PARAMS = {
    "points": {
        "folder": lambda wildcards: f"{RESULTS}/points",
        "points": STUDY.points,
        "of_points": POINT_SOURCES,
    },
    "models": {
        "model": model_config(STUDY),
        "blocks": STUDY.blocks,
        "grid": list(STUDY.grid.values()),
    },
}


rule summary:
    """Make all summaries of the study, and the verdicts on the claims of the paper."""
    input:
        expand(f"{SUMMARY}/{{name}}.nc", name=MADE),
        [
            f"{SUMMARY}/{name}.{suffix}"
            for name in MADE
            for suffix in TEXTS.get(name, ())
        ],
        CLAIMS_MADE,


for name, row in SUMMARIES.items():
    if name not in MADE:
        continue

    rule:
        name:
            name
        input:
            **SUMMARY_FILES[row["of"]],
            summaries=[
                f"{SUMMARY}/{other}.nc"
                for other in row.get("summaries", [])
                if other in MADE
            ],
        output:
            f"{SUMMARY}/{name}.nc",
            [
                report(
                    f"{SUMMARY}/{name}.{suffix}",
                    caption=f"../report/{name}_{suffix}.rst",
                    category="Friction laws",
                    labels={"result": result, "paper": "none"},
                )
                for suffix, result in row.get("texts", {}).items()
            ],
        log:
            f"{RESULTS}/logs/{name}.log",
        benchmark:
            f"{RESULTS}/benchmarks/{name}.tsv"
        priority: 4 if name in OF_PAPER_FIGURES else 0
        group:
            group("summaries")
        resources:
            mem_mb=row.get("mem_mb", 400),
            runtime=30,
        params:
            **SUMMARY_PARAMS[row["of"]],
            script=f"summary_of_{row['of']}",
            summary=name,
            config=keys(STUDY, *row.get("keys", [])),
            sources=sources(f"summary_of_{row['of']}", f"summaries.{name}"),
            seals=seals,
        message:
            f"summary: {name}"
        script:
            "../scripts/{params.script}.py"

    # Set here, since a docstring inside would be the same for all; an importing workflow names rules itself.
    if not IMPORTED:
        workflow.get_rule(name).docstring = row["docstring"]
