# What the declaration of a rule in burridge_knopoff.jobs says, in the terms of Snakemake.


def inputs(rule, name):
    """Return a function that gives the files of a name that a job reads."""
    return lambda wildcards: paths(JOBS.inputs(rule, dict(wildcards))[name])


def points_of(rule):
    """Return a function that gives the points that a job reads, or the marks of their chunks."""
    return lambda wildcards: paths(JOBS.point_files(rule, dict(wildcards)))


def abouts(rule):
    """Return a function that tells what the files of a job must be made from, which they are sealed with."""

    def of_job(wildcards):
        if rule.name not in JOBS.existing:
            raise ConfigError(rule.refusal)
        return JOBS.abouts(rule, dict(wildcards))

    return of_job


def shown_in_report(path, shown):
    """Return a file as `snakemake --report` shows it, if it does."""
    if shown is None:
        return path
    caption = f"../report/{shown.caption}.rst"
    labels = {"result": shown.title, "paper": shown.paper}
    return report(path, caption=caption, category=shown.category, labels=labels)


def resources_of(rule):
    """Return what a job needs."""
    memory, shared = rule.memory, rule.cores != 1
    needed = {
        # A profile sets this if threads are the width of a group: `cores` in workflow/profiles/slurm.
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
    """Return what decides nothing in the files of a rule."""
    words = "".join(shown.words for shown in rule.shown.values())
    params = {"caption": lambda wildcards: words.format(**wildcards)} if words else {}
    return (
        {**params, "arguments": CONFIG_ARGUMENTS} if rule.name == "report" else params
    )
