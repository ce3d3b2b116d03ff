# All that follows from the points: a rule for each that src/burridge_knopoff/jobs declares for the study. There stands
# what a rule reads, what of the config decides its files, and which function makes them.


for declared in JOBS.defined.values():
    if not declared.make:
        continue

    rule:
        name:
            declared.name
        input:
            **{name: inputs(declared, name) for name in declared.reads},
            **({"points": points_of(declared)} if declared.points else {}),
        output:
            [
                shown_in_report(f"{RESULTS}/{form}", declared.shown.get(form))
                for form in declared.files
            ],
        log:
            f"{RESULTS}/logs/{declared.log_name}.log",
        benchmark:
            f"{RESULTS}/benchmarks/{declared.log_name}.tsv"
        wildcard_constraints:
            **{
                name: "|".join(dict.fromkeys(job[name] for job in declared.each))
                for name in declared.each[0]
                if name not in ("law", "initial", *STUDY.wildcards)
            },
        priority: declared.priority
        group:
            group(declared.group)
        threads: declared.cores or SHARED_CORES
        resources:
            **resources_of(declared),
        params:
            **further_params(declared),
            abouts=abouts(declared),
        message:
            filled(declared.message)
        script:
            "../scripts/job.py"

    # Set here, since a docstring inside would be the same for all; an importing workflow names rules itself.
    if not IMPORTED:
        workflow.get_rule(declared.name).docstring = declared.purpose


rule summary:
    """Make all summaries of the study, and the verdicts on the claims of the paper."""
    input:
        paths(JOBS.files("summary/")),


# The figures of the paper, which the display announces first.
PLAN.first = [rule.name for rule in JOBS.paper_figures()]


rule figures:
    """Draw all figures of the study."""
    input:
        paths(JOBS.files("figures/")),


rule curves:
    """Draw the figures of the paper."""
    input:
        made(*JOBS.paper_figures()),
    message:
        f"the figures of the paper are in {RESULTS}/figures"


if "chains_summary" in JOBS.defined:

    rule chains:
        """Make the summary and the figure of longer chains, whether or not they are a part of `all`."""
        input:
            [
                made(JOBS.defined[name])
                for name in ("chains_summary", "figure_chains")
                if name in JOBS.defined
            ],
        message:
            f"longer chains: {RESULTS}/summary/chains.nc and {RESULTS}/figures/chains.png"
