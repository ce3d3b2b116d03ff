# What the rules have in common.

#: Priority of the figures of the paper, which are made first, and of the summaries that they show.
FIRST = 4
#: The wildcards of the jobs of a rule: of one without wildcards, and of one with a job for each law.
ONCE = [{}]
LAWS = [{"law": law} for law in STUDY.laws]
#: Keys of the config that define the models, and the model under one law; criteria of kinds of motion.
MODELS = [*MODEL_KEYS]
MODEL_OF_LAW = ["laws.{law}", *MODELS[1:]]
MOTION = ["motion", "synchronization_threshold", "section"]


def uses(*keys, stage, jobs=ONCE, over="a", refusal="", by_name=False):
    """Return a params function: the keys of the config that a job uses, with their values.

    keys : names, lists of names, and functions of the wildcards; wildcards stand in braces, as in `laws.{law}`
    stage : the part of the study to which the rule belongs; a config can leave out some
    jobs : the wildcards of all jobs of the rule
    over : the studies that can have the rule: over a alone, over `several` parameters, or over `any`
    refusal : the reason why this study does not have it; a request of its files is refused with this reason
    by_name : whether only a request by name makes its files
    """

    known = {frozenset(job.items()) for job in jobs}

    # Snakemake does not compare params that are functions of the output.
    def of_job(wildcards):
        if frozenset(wildcards.items()) not in known or of_job.refusal:
            raise ConfigError(f"{dict(wildcards)}: {of_job.refusal or 'this study has no such job'}")
        names = [key(wildcards) if callable(key) else key for key in keys]
        lists = [[name] if isinstance(name, str) else name for name in names]
        used = [name.format(**wildcards) for name in chain.from_iterable(lists)]
        return select(STUDY.config, STUDY.parameters, used)

    of_job.study, of_job.stage, of_job.jobs, of_job.by_name = STUDY, stage, jobs, by_name
    of_job.refusal = STUDY.omission(stage, over) or refusal
    return of_job


def simulates(stage):
    """Return a params function: the command of a run of some stage."""

    def of_job(wildcards):
        if of_job.refusal:
            raise ConfigError(f"{dict(wildcards)}: {of_job.refusal}")
        return STUDY.command(**wildcards)

    of_job.study, of_job.stage, of_job.refusal = STUDY, stage, STUDY.omission(stage, "any")
    return of_job


def sources(script, *modules):
    """Return the sources of a rule: its script and further modules, and the fingerprint of all that these import."""
    path = ROOT / f"workflow/scripts/{script}.py"
    return " ".join([path.name, *modules, source_fingerprint(path, *modules)])


def jobs_of(rule, jobs):
    """Return the output of all jobs of a rule."""
    return [file for job in jobs for file in expand(rule.output, **job)]


def optional(stage, file):
    """Return a file of a stage, none if the study leaves the stage out."""
    return [] if STUDY.omission(stage) else file


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
    # Without a number of cores, as on a cluster, there is one.
    return max(2, (workflow.resource_settings.cores or 1) // len(STUDY.laws))


def all_threads(wildcards, threads):
    """Return the cores of a job on a cluster: a profile sets them where `threads` is the width of a group."""
    return threads


def memory(megabytes):
    """Return the memory of a job with several processes, which need 100 MB each."""
    return lambda wildcards, threads: megabytes + 100 * threads


def point_files(**values):
    """Return the points at some values of the wildcards, by default all, or the marks of the chunks of all points."""
    if STUDY.is_plane:
        return expand(rules.chunk.output, chunk=chunks(STUDY))
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
    names = [f"{RESULTS}/summary/{name}.nc" for name in READS]
    return [name for name in names if name in FILES]


def figures_of_claims(wildcards):
    """Return the names of the figures to which claims refer."""
    named = {claim.figure for claim in CLAIMS.values()}
    return sorted(name for name in named if f"{RESULTS}/figures/{name}.png" in FILES)


# {file of the study, except points: its rule and its log}; the files that only a request by name makes; {rule or file
# that the study does not have: why}. Filled in by `add_files` when all rules are known.
FILES, BY_NAME, REFUSALS = {}, set(), {}


def files_in(*starts, suffix=""):
    """Return an input function: those files of the study that `all` makes, by the start and the end of their names."""
    starts = tuple(f"{RESULTS}/{start}" for start in starts)
    return lambda wildcards: [
        file for file in FILES if file not in BY_NAME and file.startswith(starts) and file.endswith(suffix)
    ]


def params_of(rule):
    """Return the params function of a rule that says what its jobs use; None for rules of other studies and workflows."""
    return next((param for param in rule.params if getattr(param, "study", None) is STUDY), None)


def add_files():
    """Fill in `FILES`, `BY_NAME` and `REFUSALS` from the rules of this study and the jobs that their params name."""
    for item in workflow.rules:
        params = params_of(item)
        if params and params.refusal:
            REFUSALS[item.name] = params.refusal
        # Points follow from the grid.
        if not hasattr(params, "jobs"):
            continue
        reads = {f"{file}" for file in item.input if not is_callable(file)}
        reason = params.refusal or next((REFUSALS[file] for file in reads if file in REFUSALS), "")
        for job in params.jobs:
            made = [apply_wildcards(f"{file}", job) for file in item.output]
            if reason:
                REFUSALS.update(dict.fromkeys(made, reason))
                continue
            FILES.update(dict.fromkeys(made, (item, apply_wildcards(f"{item.log[0]}", job))))
            if params.by_name or reads & BY_NAME:
                BY_NAME.update(made)
