# What the rules have in common.

#: Priority of the figures of the paper, which are made first, and of the summaries that they show.
FIRST = 4
#: The files of the study, except its points, by their names in the results.
FILES = study_files(STUDY)
#: Keys of the config that define the models, and the model under one law; criteria of kinds of motion.
MODELS = [*MODEL_KEYS]
MODEL_OF_LAW = ["laws.{law}", *MODELS[1:]]
MOTION = ["motion", "synchronization_threshold", "section"]

SERVER = ScriptServer()
# The rules call it by this name.
script = internals.script_in_fork(workflow, script, SERVER, ROOT / "workflow/scripts")


def uses(rule, *keys):
    """Return a params function: the keys of the config that a job of a rule uses, with their values.

    keys : names, lists of names, and functions of the wildcards; wildcards stand in braces, as in `laws.{law}`
    A job that the study does not have is refused with the reason.
    """
    jobs = {frozenset(job.items()) for job in outputs()[rule].jobs(STUDY)}

    # Snakemake does not compare params that are functions of the output.
    def of_job(wildcards):
        reason = refusal(STUDY, rule)
        if reason or frozenset(wildcards.items()) not in jobs:
            raise ConfigError(f"{rule} {dict(wildcards)}: {reason or 'this study has no such job'}")
        names = [key(wildcards) if callable(key) else key for key in keys]
        lists = [[name] if isinstance(name, str) else name for name in names]
        used = [name.format(**wildcards) for name in chain.from_iterable(lists)]
        return select(STUDY.config, STUDY.parameters, used)

    return of_job


def simulates(rule):
    """Return a params function: the command of a run."""

    def of_job(wildcards):
        if reason := refusal(STUDY, rule):
            raise ConfigError(f"{rule} {dict(wildcards)}: {reason}")
        return STUDY.command(**wildcards)

    return of_job


def sources(script, *modules):
    """Return the sources of a rule: its script and further modules, and the fingerprint of all that these import."""
    path = ROOT / f"workflow/scripts/{script}.py"
    return " ".join([path.name, *modules, source_fingerprint(path, *modules)])


def made(*names):
    """Return the outputs of all jobs of some rules, none of a rule that the study does not have."""
    return [
        file
        for name in names
        if not refusal(STUDY, name)
        for job in outputs()[name].jobs(STUDY)
        for file in expand(getattr(rules, name).output, **job)
    ]


def optional(rule, file):
    """Return a file of a rule, none if the study does not have it."""
    return [] if refusal(STUDY, rule) else file


def shown(name, title, category, paper="none"):
    """Return a text among the summaries, which `snakemake --report` shows with its caption."""
    caption = f"../report/{name.replace('.', '_')}.rst"
    labels = {"result": title, "paper": paper}
    return report(f"{RESULTS}/summary/{name}", caption=caption, category=category, labels=labels)


def shared_cores(wildcards):
    """Return the cores of a long job, shared among its processes.

    The jobs of all laws run at the same time, each with at least two cores, since with one core each they would not end
    together.
    """
    return max(2, internals.requested_cores(workflow) // len(STUDY.laws))


def all_threads(wildcards, threads):
    """Return the cores of a job on a cluster: a profile sets them where `threads` is the width of a group."""
    return threads


def memory(megabytes):
    """Return the memory of a job with several processes, which need 100 MB each."""
    return lambda wildcards, threads: megabytes + 100 * threads


def point_files(**values):
    """Return the points at some values of the wildcards, by default all, or the marks of the chunks of all points."""
    if STUDY.is_plane:
        return made("chunk")
    return expand(rules.simulate.output, **{**GRID, **values})


def all_point_files(wildcards):
    """Return all points, as an input function."""
    return point_files()


def shown_points(wildcards):
    """Return the points of the runs that a figure shows."""
    initial = wildcards.get("initial", STUDY.initial)
    return point_files(law=STUDY.shown_law, initial=initial, a=STUDY.shown_point)


def input_of(figure):
    """Return the named input of a figure."""
    if figure.of_points:
        return {"points": shown_points}
    return {"summaries": [f"{RESULTS}/summary/{name}.nc" for name in figure.inputs]}


def keys_of(figure):
    """Return the keys of the config that a figure uses."""
    if figure.of_points:
        state = "initial.{initial}" if "{initial}" in figure.file else "initial"
        return [*run_keys(STUDY, STUDY.shown_law), state, "figures.a", "figures.law"]
    return [key for name in figure.from_study for key in study_keys(STUDY, name)]


def catalogue_keys(wildcards):
    """Return the keys of one run."""
    section, solver = STUDY.config["catalogue"], STUDY.config["solver"][wildcards.law]
    return [
        *("start", "solver.{law}", f"initial.{section['initial']}"),
        *(["step"] if solver == "rk4" else []),
        # The ends of the range of the fit affect only the statistics.
        *parts(STUDY, "catalogue", "a", "low", "high"),
    ]


def read_by_judges(wildcards):
    """Return the summaries of the study that judges read."""
    names = [f"summary/{name}.nc" for name in READS]
    return [f"{RESULTS}/{name}" for name in names if name in FILES and not refusal(STUDY, FILES[name].rule)]


def figures_of_claims(wildcards):
    """Return the names of the figures to which claims refer."""
    named = {claim.figure for claim in CLAIMS.values()}
    return sorted(name for name in named if f"figures/{name}.png" in FILES)
