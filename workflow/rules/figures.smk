# Figures, as PDF for print and PNG for the screen: a rule for each module of burridge_knopoff.figures with a caption. The
# module says which summaries it shows, or that it shows runs.
STATES = [{"initial": initial} for initial in STUDY.initial]


rule figures:
    """Draw all figures of the study."""
    input:
        files_in("figures/"),


rule curves:
    """Draw the figures of the paper, or those over several parameters."""
    input:
        files_in(
            *(
                f"figures/{figure.file.partition('{')[0]}"
                for figure in figure_descriptions()
                if figure.paper or STUDY.is_plane
            )
        ),
    message:
        f"the figures {'over the parameters' if STUDY.is_plane else 'of the paper'} are in {RESULTS}/figures"


for figure in figure_descriptions():
    words = figure.title.replace("{initial}", "{wildcards.initial}")

    rule:
        """Draw what the module of that name in src/burridge_knopoff/figures describes."""
        name:
            f"figure_{figure.name}"
        input:
            **input_of(figure),
        output:
            f"{RESULTS}/figures/{figure.file}.pdf",
            report(
                f"{RESULTS}/figures/{figure.file}.png",
                caption="../report/figure.rst",
                category=figure.category,
                labels={"result": figure.title, "paper": figure.paper or "none"},
            ),
        log:
            f"{RESULTS}/logs/figure_{figure.file}.log",
        benchmark:
            f"{RESULTS}/benchmarks/figure_{figure.file}.tsv"
        priority: FIRST if figure.paper else 0
        params:
            config=uses(
                *keys_of(figure),
                stage="figures",
                over=figure.over,
                jobs=STATES if "{initial}" in figure.file else ONCE,
                refusal=condition_refusal(STUDY, figure.condition),
            ),
            sources=sources("figure", f"burridge_knopoff.figures.{figure.name}"),
            figure=figure.name,
            caption=figure.caption_of({"initial": "{initial}"}),
        message:
            f"figure: {words}"
        script:
            "../scripts/figure.py"
