# Figures: a rule for each module of burridge_knopoff.figures that has a caption, as PDF for print and PNG for the screen.
from burridge_knopoff.figures.description import study_figures
from burridge_knopoff.study.stages import CHAIN_SUMMARIES

# Those of longer chains too, which have a target of their own: it refuses a chain that has one length only.
DESCRIPTIONS = study_figures(STUDY, CHAIN_SUMMARIES)
SHOWN_RUNS = f"{RESULTS}/points/{POINT}".format(
    law=STUDY.shown_law, a=STUDY.shown_point, initial="{initial}"
)


# The figures of the paper; of the logger's own words they are the first.
OF_PAPER = [figure for figure in DESCRIPTIONS if figure.paper]
PLAN.first = [f"figure_{figure.name}" for figure in OF_PAPER]


rule curves:
    """Draw the figures of the paper."""
    input:
        pictures(OF_PAPER),
    message:
        f"the figures of the paper are in {FIGURES}"


# Without those of the optional stage.
rule figures:
    """Draw all figures but that of longer chains."""
    input:
        pictures([figure for figure in DESCRIPTIONS if "chains" not in figure.inputs]),


for figure in DESCRIPTIONS:

    rule:
        name:
            f"figure_{figure.name}"
        input:
            # Of one initial state if the name of the picture has it, else of each.
            expand(
                SHOWN_RUNS,
                initial=("{initial}" if "{initial}" in figure.file else STUDY.initial),
            )
            if figure.of_runs
            else [f"{SUMMARY}/{name}.nc" for name in figure.inputs],
        output:
            f"{FIGURES}/{figure.file}.pdf",
            report(
                f"{FIGURES}/{figure.file}.png",
                caption="../report/figure.rst",
                category=figure.category,
                labels={"result": figure.title, "paper": figure.paper or "none"},
            ),
        log:
            f"{RESULTS}/logs/figure_{figure.file}.log",
        benchmark:
            f"{RESULTS}/benchmarks/figure_{figure.file}.tsv"
        # What a reader wants first runs first.
        priority: 4 if figure.paper else 0
        group:
            group("figures")
        params:
            script=figure.script,
            figure=figure.name,
            caption=figure.caption_of,
            folder=lambda wildcards: f"{RESULTS}/points",
            runs=STUDY.shown_runs if figure.of_runs else None,
            of_points=POINT_SOURCES if figure.of_runs else None,
            from_study={name: getattr(STUDY, name) for name in figure.from_study},
            sources=sources(figure.script, f"figures.{figure.name}"),
            seals=seals,
        message:
            f"figure: {figure.title.replace('{', '{wildcards.')}"
        script:
            "../scripts/{params.script}.py"

    # Written inside, it would be the same for all of them; an importing workflow names rules by itself.
    if not IMPORTED:
        workflow.get_rule(f"figure_{figure.name}").docstring = (
            f"Draw {figure.subject}"
        )
