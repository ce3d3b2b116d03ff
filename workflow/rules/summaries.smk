# Summaries of points, and of models alone: a netCDF file a question, by the module of its name in burridge_knopoff.summaries.
from burridge_knopoff.figures.description import figure_descriptions
from burridge_knopoff.study.stages import TEXTS

# What the figures of the paper show comes first.
OF_PAPER_FIGURES = {
    name for figure in figure_descriptions() if figure.paper for name in figure.inputs
}

# What a summary is of; what else it reads; keys of the config that it uses; texts beside it, {suffix: result}.
SUMMARIES = {
    "mean_distance": {"of": "points", "keys": ["synchronization_threshold"]},
    "bifurcation": {"of": "points", "mem_mb": 1000},
    "lyapunov": {
        "of": "points",
        "keys": ["lyapunov_exponents", "synchronization_threshold", "motion"],
    },
    "agreement": {
        "of": "points",
        "summaries": ["lyapunov", "attractors"],
        "keys": ["synchronization_threshold", "agreement"],
        "texts": {"csv": "table of the agreement", "txt": "agreement in words"},
    },
    "stick_slip": {"of": "points", "keys": ["transient", "window", "batches"]},
    "orbits": {"of": "models"},
    "equilibrium": {"of": "models"},
}
# Of these and of the stages that the study has.
MADE = [*SUMMARIES, *STUDY.stage_summaries]
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
        "model": model_config(),
        "blocks": STUDY.blocks,
        "grid": list(STUDY.grid.values()),
    },
}


rule summary:
    input:
        expand(f"{SUMMARY}/{{name}}.nc", name=MADE),
        [
            f"{SUMMARY}/{name}.{suffix}"
            for name in MADE
            for suffix in TEXTS.get(name, ())
        ],
        CLAIMS_MADE,


for name, row in SUMMARIES.items():

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
            config=keys(*row.get("keys", [])),
            sources=sources(f"summary_of_{row['of']}", f"summaries.{name}"),
            seals=seals,
        message:
            f"summary: {name}"
        script:
            "../scripts/{params.script}.py"
