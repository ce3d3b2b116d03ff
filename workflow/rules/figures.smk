# Figures: a rule for each module of burridge_knopoff.figures that has a caption, as PDF for print and PNG for the screen.
from burridge_knopoff.figures.description import study_figures
from burridge_knopoff.study.stages import CHAIN_SUMMARIES

# Includes figures of longer chains, whose own target refuses a chain of fixed length.
DESCRIPTIONS = study_figures(STUDY, () if STUDY.is_plane else CHAIN_SUMMARIES)
SHOWN_RUNS = f"{RESULTS}/points/{POINT}".format(
    law=STUDY.shown_law, a=STUDY.shown_point, initial="{initial}"
)


# The figures of the paper, which the display announces first.
OF_PAPER = [figure for figure in DESCRIPTIONS if figure.paper]
PLAN.first = [f"figure_{figure.name}" for figure in OF_PAPER]


# Without the figures of the optional stage. As the first rule of the file that only gathers it names the stage of all.
rule figures:
    """Draw all figures except that of longer chains."""
    input:
        pictures([figure for figure in DESCRIPTIONS if "chains" not in figure.inputs]),


rule curves:
    """Draw the figures of the paper."""
    input:
        pictures(OF_PAPER),
    message:
        f"the figures of the paper are in {FIGURES}"


for figure in DESCRIPTIONS:

    rule:
        name:
            f"figure_{figure.name}"
        input:
            # The runs of one initial state if the picture's name has it, else of all.
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
        # The figures wanted first run first.
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

    # Set here, since a docstring inside would be the same for all; an importing workflow names rules itself.
    if not IMPORTED:
        workflow.get_rule(f"figure_{figure.name}").docstring = (
            f"Draw {figure.subject}"
        )
