# Everything that is computed from the points: one rule for each declaration in src/burridge_knopoff/jobs, which says
# what the rule reads, which parts of the config determine its files, and which function makes them.


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
                mark_for_report(f"{RESULTS}/{form}", declared.shown.get(form))
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
            config=config_of(declared),
        message:
            snakemake_message(declared.message)
        script:
            "../scripts/job.py"

    # Set here, since all rules would share a docstring inside; an importing workflow names its rules itself.
    if not IMPORTED:
        workflow.get_rule(declared.name).docstring = declared.purpose


rule summary:
    """Compute all summaries of the study, and the verdicts on the claims of the paper."""
    input:
        paths(JOBS.files("summary/")),


# The display announces the figures of the paper as soon as they are drawn. A study of several parameters has none.
if not STUDY.is_plane:
    PLAN.first = [rule.name for rule in JOBS.paper_figures()]
FIRST_FIGURES = (
    "figures over the parameters" if STUDY.is_plane else "figures of the paper"
)


rule figures:
    """Draw all figures of the study."""
    input:
        paths(JOBS.files("figures/")),


rule curves:
    """Draw the figures of the paper, or those over several parameters."""
    input:
        output_paths(*JOBS.paper_figures()),
    message:
        f"the {FIRST_FIGURES} are in {RESULTS}/figures"


if "chains_summary" in JOBS.defined:

    rule chains:
        """Make the summary and the figure of longer chains, even if they are not part of `all`."""
        input:
            [
                output_paths(JOBS.defined[name])
                for name in ("chains_summary", "figure_chains")
                if name in JOBS.defined
            ],
        message:
            f"longer chains: {RESULTS}/summary/chains.nc and {RESULTS}/figures/chains.png"
