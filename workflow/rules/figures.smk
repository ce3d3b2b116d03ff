# Figures, as PDF for print and PNG for the screen: a rule for each module of burridge_knopoff.figures with a caption. The
# module says which summaries it shows, or that it shows runs.

HAS_PAPER_CHAIN = STUDY.has_paper_chain

for figure in figure_descriptions():
    words = figure.title.replace("{initial}", "{wildcards.initial}")

    rule:
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
                labels={"result": figure.title, "paper": (HAS_PAPER_CHAIN and figure.paper) or "none"},
            ),
        log:
            f"{RESULTS}/logs/figure_{figure.file}.log",
        benchmark:
            f"{RESULTS}/benchmarks/figure_{figure.file}.tsv"
        priority: FIRST if figure.paper else 0
        params:
            config=uses(f"figure_{figure.name}", *keys_of(figure)),
            sources=sources("figure", f"burridge_knopoff.figures.{figure.name}"),
            figure=figure.name,
            caption=figure.caption_of({"initial": "{initial}"}, HAS_PAPER_CHAIN),
        message:
            f"figure: {words}"
        script:
            "../scripts/figure.py"

    internals.describe(getattr(rules, f"figure_{figure.name}"), figure.words)
