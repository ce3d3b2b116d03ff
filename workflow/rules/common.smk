# The declarations of rules in burridge_knopoff.jobs, in Snakemake's terms.


def inputs(rule, name):
    """Return the input function of a rule for one of its named inputs."""
    return lambda wildcards: paths(JOBS.inputs(rule, dict(wildcards))[name])


def points_of(rule):
    """Return the input function of a rule for the points that it reads, or for the marks of their chunks."""
    return lambda wildcards: paths(JOBS.point_files(rule, dict(wildcards)))


def config_of(rule):
    """Return a params function: the keys of the config on which the files of a job depend, with their values."""

    def of_job(wildcards):
        if rule.name not in JOBS.existing:
            names = [rule.name, *paths(form.format(**wildcards) for form in rule.files)]
            asked = [name for name in names if name in workflow.dag_settings.targets]
            raise ConfigError(f"{[*asked, rule.name][0]}: not made: {rule.refusal}")
        return JOBS.config(rule, dict(wildcards))

    return of_job


def mark_for_report(path, shown):
    """Return a file, marked for `snakemake --report` if that shows it."""
    if shown is None:
        return path
    caption = f"../report/{shown.caption}.rst"
    labels = {"result": shown.title, "paper": shown.paper}
    return report(path, caption=caption, category=shown.category, labels=labels)


def resources_of(rule):
    """Return the resources of a job."""
    memory, shared = rule.memory, rule.cores != 1
    needed = {
        # A profile sets this where `threads` is the width of a group: `cores` in workflow/profiles/slurm.
        "cpus_per_task": (lambda wildcards, threads: threads) if shared else None,
        "mem_mb": (
            (lambda wildcards, threads: memory + 100 * threads)
            if memory and shared
            else memory
        ),
        "runtime": rule.minutes,
    }
    return {name: value for name, value in needed.items() if value}


def further_params(rule):
    """Return what a job uses besides the keys of the config."""
    words = "".join(shown.words for shown in rule.shown.values())
    params = {
        "rule": rule.name,
        "make": rule.make,
        "module": rule.sources[-1],
        "results": lambda wildcards: RESULTS,
        "sources": source_fingerprint(*rule.sources),
    }
    if words:
        params["caption"] = lambda wildcards: words.format(**wildcards)
    if rule.figures:
        params["figures"] = rule.figures
    if rule.name == "report":
        params["arguments"] = CONFIG_ARGUMENTS
    return params
