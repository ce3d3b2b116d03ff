# What happens when the workflow has been read, and when a run starts: the study is recorded in its folder, and remarks are
# printed. No result is removed or renamed; only the empty marks of incomplete chunks are removed.


def record_study():
    """Record the study and its command in the results folder.

    The record is no output of a rule. If it were an input of the jobs, even an `ancient` one, Snakemake 9.27 would not
    look at the params of any job in the run that renews it, and would repeat all of them where it is missing.
    """
    write_study_record(
        RESULTS,
        STUDY.config,
        STUDY.parameters,
        OWNER,
        WRITTEN,
        shlex.join(ARGUMENTS),
    )


def write_line(text):
    """Write a line to standard error, in one piece: Snakemake writes to it from another thread."""
    sys.stderr.write(f"{escape_unprintable(text)}\n")


def print_remarks():
    """Print what users may not expect of this study, a line each."""
    made_from = {file: getattr(rules, item.rule).params.sources for file, item in FILES.items()}
    for remark in (
        *remarks(STUDY, GIVEN),
        *change_remarks(changes(STUDY, Path(RESULTS), made_from)),
        *override_remarks(STUDY, RESULTS, display_path(CONFIG_FILE), OVERRIDES),
    ):
        write_line(remark)


def prepare_cluster():
    """Before jobs are submitted to Slurm, cancel those that a killed run has left: they may make files of another config.

    Jobs of a run that is not over, of other targets of the same study, are left alone. Ends the run, with one line, if
    Slurm does not answer: each job would try for minutes.
    """
    program = internals.submit_program(workflow)
    if not program or program.name != "submit.py" or not program.with_name("jobs.py").is_file():
        return
    answer = subprocess.run(["sh", "-c", "squeue --me --noheader"], capture_output=True, text=True)
    if answer.returncode:
        sys.exit(f"no job is submitted, Slurm does not answer: squeue: {answer.stderr.strip()}")
    # The name of the study, to the programs that submit jobs.
    os.environ.update(BK_STUDY=STUDY.name)
    if not OTHER_RUN and subprocess.run([sys.executable, program.with_name("jobs.py"), STUDY.name]).returncode:
        sys.exit(1)


def prepare_results():
    """Check that the results folder is writable, record the study in it, and plan the run."""
    prepare_cluster()
    print_remarks()
    try:
        check_folder(RESULTS, inside=True)
        record_study()
    except OSError as error:
        sys.exit(escape_unprintable(f"{error}"))
    # Shells and Snakemake open these files as they are.
    for _, job, _ in internals.planned_jobs(workflow):
        remove_links(*job.log, *([job.benchmark] if job.benchmark else []))
    internals.start_no_timers(workflow)
    internals.end_on_termination(workflow, STOP, SERVER)
    PLAN.announce()


def remove_marks(makes_files):
    """Remove marks of incomplete chunks, so that Snakemake finds them missing; say so if this run makes no files."""
    for mark in incomplete_chunks(STUDY, Path(RESULTS)):
        if makes_files:
            mark.unlink()
        words = "is" if makes_files else "would be"
        write_line(f"{mark}: a point of this chunk is missing or was changed: it {words} made again")


PLAN = Plan(STUDY, RESULTS, workflow, IMPORTED, record_study)
for handler in internals.log_handlers(workflow):
    if isinstance(handler, LogHandler):
        handler.set_plan(PLAN)

# Snakemake has no hook before it decides which jobs to run. Only in the main process, not in jobs, and not while another
# run writes these files.
if internals.is_main_process(workflow):
    # Snakemake would warn of each missing file.
    if only_reports(sys.argv[1:]) and not Path(RESULTS).is_dir():
        sys.exit(f"--report: {RESULTS} is missing: run the study first, by the same command without --report")
    try:
        check_places(Path(RESULTS), STUDY)
    except OSError as error:
        sys.exit(escape_unprintable(f"{error}"))
    IS_DRY_RUN, OTHER_RUN = internals.is_dry_run(workflow), is_locked(Path(RESULTS))
    if not OTHER_RUN:
        remove_marks(runs_jobs(sys.argv[1:]) and not IS_DRY_RUN)
    # A dry run calls no hook.
    if IS_DRY_RUN:
        print_remarks()


# Snakemake calls this for the main Snakefile; a workflow that imports the study calls it itself.
onstart:
    prepare_results()
