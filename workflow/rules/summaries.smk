# Summaries of points, and of models alone: one netCDF file a question, by the module of its name in `summaries`.
from burridge_knopoff.figures.description import figure_descriptions
from burridge_knopoff.study.summary_rows import SUMMARY_ROWS, TEXTS

# Summaries in the figures of the paper come first.
OF_PAPER_FIGURES = {
    name for figure in figure_descriptions() if figure.paper for name in figure.inputs
}

# Of the summaries in the table and of those of stages, those that the study has.
MADE = [name for name in SUMMARY_ROWS if STUDY.has_summary(name)]
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


for name, row in SUMMARY_ROWS.items():
    if name not in MADE:
        continue

    rule:
        name:
            name
        input:
            **SUMMARY_FILES[row.of],
            summaries=[
                f"{SUMMARY}/{other}.nc" for other in row.summaries if other in MADE
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
                for suffix, result in row.texts.items()
            ],
        log:
            f"{RESULTS}/logs/{name}.log",
        benchmark:
            f"{RESULTS}/benchmarks/{name}.tsv"
        priority: 4 if name in OF_PAPER_FIGURES else 0
        group:
            group("summaries")
        resources:
            mem_mb=row.memory,
            runtime=30,
        params:
            **SUMMARY_PARAMS[row.of],
            script=f"summary_of_{row.of}",
            summary=name,
            config=keys(STUDY, *row.keys),
            sources=sources(f"summary_of_{row.of}", f"summaries.{name}"),
            seals=seals,
        message:
            f"summary: {name}"
        script:
            "../scripts/{params.script}.py"

    # Set here, since a docstring inside would be the same for all; an importing workflow names rules itself.
    if not IMPORTED:
        workflow.get_rule(name).docstring = row.purpose
