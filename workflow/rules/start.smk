# What happens when the workflow has been read, and when a run starts: the study is recorded in its folder, damaged texts and
# pictures are set aside, and remarks are printed.


def record_study():
    """Record the study, its files and its command in the results folder."""
    files = {inside(file): inside(log) for file, (_, log) in FILES.items()}
    write_study_record(
        RESULTS,
        STUDY.config,
        STUDY.parameters,
        CONFIG_FILE,
        WRITTEN,
        shlex.join(ARGUMENTS),
        files,
    )


def inside(path):
    """Return the name of a file in the results."""
    return path.removeprefix(f"{RESULTS}/")


def write_line(text):
    """Write a line to standard error, in one piece: Snakemake writes to it from another thread."""
    sys.stderr.write(f"{text}\n")


def print_remarks():
    """Print what users may not expect of this study, a line each."""
    made_from = {inside(file): rule.params["sources"] for file, (rule, _) in FILES.items()}
    for remark in (
        *remarks(STUDY, GIVEN),
        *points_of_grid(STUDY),
        *kept_stages(STUDY, {rule.params["config"].stage for rule, _ in FILES.values()}),
        *changed_params(changes(STUDY, Path(RESULTS), made_from)),
        *replaced_results(STUDY, RESULTS, display_path(CONFIG_FILE), OVERRIDES),
    ):
        write_line(remark)


def prepare_results():
    """Check that the results folder is writable, record the study in it, and plan the run."""
    if error := cluster_error(submit_command(workflow)):
        sys.exit(error)
    # The name of the study, to the programs that submit jobs.
    os.environ.update(BK_STUDY=STUDY.name)
    cancel_left_jobs(submit_command(workflow))
    print_remarks()
    try:
        check_folder(RESULTS, inside=True)
        record_study()
    except OSError as error:
        sys.exit(f"{error}")
    lift_job_rate_limit(workflow)
    PLAN.announce()


def cancel_left_jobs(submit):
    """Cancel the jobs that a killed run has left on Slurm: they may make files of another config at any time.

    Jobs of a run that is not over, of other targets of the same study, are left alone.
    """
    program = Path(submit or "")
    jobs = program.parent / "jobs.py"
    if program.name == "submit.py" and jobs.is_file() and not OTHER_RUN:
        if subprocess.run([sys.executable, jobs, STUDY.name]).returncode:
            sys.exit(1)


def set_damaged_aside(makes_files):
    """Set damaged texts and pictures aside, so that Snakemake finds them missing; say so if this run makes no files."""
    for path, reason in damaged_files(STUDY, Path(RESULTS), map(inside, FILES)):
        words = "would be made again"
        # Someone may have edited it on purpose. Otherwise it is empty, or its job was killed.
        if makes_files and reason == CHANGED:
            path.replace(f"{path}.damaged")
            words = f"is made again; kept as {path.name}.damaged"
        elif makes_files:
            path.unlink()
            words = "is made again"
        write_line(f"{path}: {reason}: it {words}")


add_files()
PLAN.results, PLAN.workflow, PLAN.study = RESULTS, workflow, STUDY
PLAN.config, PLAN.checkout, PLAN.record = f"{CONFIG_FILE}", ROOT, record_study
PLAN.files = {file: rule.name for file, (rule, _) in FILES.items()}
PLAN.rules = {each.name: params_of(each) for each in workflow.rules if params_of(each)}
# The display announces the figures of the paper as soon as they are drawn. A study of several parameters has none.
if not STUDY.is_plane:
    PLAN.first = [FILES[file][0].name for file in rules.curves.input[0]({})]

# Snakemake has no hook before it decides which jobs to run. Only in the main process, not in jobs, and not while another
# run writes these files.
if not is_job(workflow):
    OTHER_RUN = is_locked(Path(RESULTS))
    if not OTHER_RUN:
        set_damaged_aside(runs_jobs(sys.argv[1:]) and not is_dry_run(workflow))
    # A dry run calls no hook.
    if is_dry_run(workflow):
        print_remarks()


onstart:
    prepare_results()


onsuccess:
    write_sums(Path(RESULTS), [*run_files(STUDY), *map(inside, FILES)])
