"""What the study and its display take from Snakemake 9 beyond its documented interface, and what each is worth."""

from __future__ import annotations

import inspect
import os
import re
import resource
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import psutil

from burridge_knopoff.running.cores import available_cores
from burridge_knopoff.script_server import Script, ScriptServer

#: Seconds in which threads end after SIGTERM once no process of a job is left.
PATIENCE = 10.0

#: The arguments of Snakemake's `script` from which the object `snakemake` of a script is made, in this order, and those
#: that name another environment.
OF_SCRIPT = (
    *("input", "output", "params", "wildcards", "threads", "resources", "log", "config", "rulename"),
    "bench_iteration",
)
ELSEWHERE = ("conda_env", "container_img", "env_modules", "shadow_dir")
#: Variables of the environment that Snakemake sets to the threads, and to the temporary folder, of a job.
THREADS = tuple(f"{name}_NUM_THREADS" for name in ("OMP", "GOTO", "OPENBLAS", "MKL", "NUMEXPR"))
TEMPORARY = ("TMPDIR", "TMP", "TEMPDIR", "TEMP")

#: What matplotlib imports when it writes a figure.
BACKENDS = ("matplotlib.backends.backend_agg", "matplotlib.backends.backend_pdf")

_IMPORTED = re.compile(r"^(?:from|import) (burridge_knopoff[.\w]*)", re.MULTILINE)


def log_handlers(workflow: Any) -> Sequence[Any]:
    """Return the log handlers of a run. No event has the dependencies of jobs: without it there is no time left."""
    return workflow.logger_manager.get_log_handlers()


def is_main_process(workflow: Any) -> bool:
    """Return whether `snakemake` itself reads the workflow, not one that it starts for a job on a cluster.

    Each of these would print the remarks on the study, and remove the marks of chunks that others are making.
    """
    return workflow.is_main_process


def is_dry_run(workflow: Any) -> bool:
    """Return whether nothing is run. A dry run calls no hook: it would print no remarks, and need the kernel."""
    return workflow.output_settings.dryrun


def command_line_config(workflow: Any) -> tuple[list[str], Mapping[str, Any]]:
    """Return the entries of --config and the values that Snakemake has read from them.

    The `config` of a Snakefile is merged already: the command that repeats a run would lack them.
    """
    settings = workflow.config_settings
    return [*(settings.config_args or [])], settings.config


def config_files(workflow: Any) -> list[Path]:
    """Return the config files of the command line, also in a study that another workflow imports."""
    return [*(workflow.config_settings.configfiles or [])]


def requested_cores(workflow: Any) -> int:
    """Return the number of cores of a run, 1 on a cluster, where `workflow.cores` raises."""
    return workflow.resource_settings.cores or 1


def named_targets(workflow: Any) -> tuple[Collection[str], list[str]]:
    """Return the targets of the command line, and these with what -R, --until and --omit-from name.

    They are unknown while the Snakefile is read. Without them a misspelt target gets a list of missing input files.
    """
    settings = getattr(workflow, "dag_settings", None)
    if not settings:
        return (), []
    return settings.targets, [*settings.targets, *settings.forcerun, *settings.until, *settings.omit_from]


def submit_program(workflow: Any) -> Path | None:
    """Return the program that submits jobs to a cluster, which a profile names. A killed run leaves its jobs there."""
    command = getattr(workflow.executor_settings, "submit_cmd", None)
    return Path(command) if command else None


def start_no_timers(workflow: Any) -> None:
    """Let a run on this machine start jobs without a limit on their rate.

    With a limit a timer starts with every job, and each of them checks all ready jobs every second until the end
    (snakemake/snakemake#3804). 484 points take 5.8 CPU s of Snakemake in place of 13.9, or 12.2 with a high limit by
    `max-jobs-per-timespan`. Programs that submit jobs to a cluster need the limit.
    """
    if not workflow.non_local_exec:
        workflow.scheduler.job_rate_limiter = None


def end_on_termination(workflow: Any, stop: Any, server: ScriptServer) -> None:
    """Let SIGTERM end a run on this machine as Ctrl-C does; stop : ends the points in threads.

    Snakemake's own handler waits for a lock that the scheduler may hold. Its threads are waited for as long as one has
    a process, since any other may wait for ever, for example for the reader of a named pipe.
    """

    def leave() -> None:
        while {process.pid for process in psutil.Process().children(recursive=True)} - {server.pid}:
            time.sleep(1.0)
        time.sleep(PATIENCE)
        workflow.persistence.unlock()
        os.write(2, b"stopped: a thread did not end\n")
        os._exit(1)

    def end(number: int, frame: object) -> None:
        signal.signal(signal.SIGTERM, signal.SIG_IGN)
        stop.set()
        threading.Thread(target=leave, daemon=True).start()
        raise KeyboardInterrupt

    if not workflow.non_local_exec and threading.current_thread() is threading.main_thread():
        signal.signal(signal.SIGTERM, end)


def run_in_thread(rule: Any, command: str) -> None:
    """Let the jobs of a rule with a `run` block run in threads of Snakemake, with a shell command that does the same.

    Snakemake starts itself anew for each job with a `run` block, which takes a second, except where a rule has a shell
    command. It shows that command with -p and in its records, and calls the block.
    """
    rule.rule.shellcmd = command


def script_in_fork(
    workflow: Any, script: Callable[..., None], server: ScriptServer, folder: Path
) -> Callable[..., None]:
    """Return what runs the scripts of rules: those of a folder in forks of a server, under Linux and on this machine.

    A start of Python takes longer than most of them work. Their benchmarks hold all CPU time that they used: Snakemake
    samples it, and misses what processes use after their last sample.

    script : Snakemake's own function, by whose name a compiled rule calls it. It runs all others: on a cluster, in an
        environment or a container, from another folder, and if its arguments have changed
    """

    def run(*arguments: Any) -> None:
        before = _seconds_of_children()
        try:
            from snakemake.benchmark import benchmarked

            job = inspect.signature(script).bind(*arguments).arguments
            record = job["bench_record"]
            process = None if workflow.remote_exec else _begin(job, server, folder)
        except (AttributeError, ImportError, KeyError, TypeError):
            record = process = None
        if process is None:
            script(*arguments)
            # A cluster runs one job at a time in a process of Snakemake.
            if record and workflow.remote_exec:
                record.cpu_time = _seconds_of_children() - before
            return
        with benchmarked((record and process.pid) or False, record):
            end = process.run()
        if end.code:
            raise subprocess.CalledProcessError(end.code, str(job["path"]))
        if record:
            record.cpu_time, record.cpu_usage = end.seconds, 100.0 * end.seconds
            # The only sample of a quick one is that of its begin.
            record.max_rss, record.max_pss = (max(size or 0.0, end.memory) for size in (record.max_rss, record.max_pss))

    return run


def _begin(job: Mapping[str, Any], server: ScriptServer, folder: Path) -> Script | None:
    """Begin the script of a job in a fork; return None if Snakemake has to run it."""
    from snakemake.iocontainers import Snakemake

    path = Path(job["basedir"].get_path_or_uri(secret_free=True), job["path"]).resolve()
    if sys.platform != "linux" or path.parent != folder or any(job[name] for name in ELSEWHERE):
        return None
    variables = {"snakemake": Snakemake(*(job[name] for name in OF_SCRIPT), str(folder))}
    modules = [Snakemake.__module__, *_IMPORTED.findall(path.read_text()), *(BACKENDS if path.stem == "figure" else ())]
    # Of the params between the name of the script and the fingerprint.
    modules += job["params"].sources.split()[1:-1]
    environment = dict.fromkeys(THREADS, str(job["threads"]))
    environment |= dict.fromkeys(TEMPORARY, str(job["resources"].tmpdir))
    return server.begin(path, variables, modules, environment)


def _seconds_of_children() -> float:
    """Return the CPU time of the processes that this one has waited for."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def describe(rule: Any, words: str) -> None:
    """Describe a rule that is made in a loop: a docstring, which --list-rules prints, would be the same for all."""
    rule.rule.docstring = words


def planned_jobs(workflow: Any) -> Iterator[tuple[int, Any, list[int]]]:
    """Yield number, job and the numbers of the jobs that it waits for, of all jobs that will make files.

    Rules are in the order of the Snakefile. This and the following two are all of the plan: the stages, the time left
    and the estimate before a run.
    """
    dag, order = workflow.dag, {rule.name: place for place, rule in enumerate(workflow.rules)}
    numbers = {job: dag.jobid(job) for job in dag.needrun_jobs(exclude_finished=False) if job.output}
    for job in sorted(numbers, key=lambda job: (order[job.rule.name], numbers[job])):
        yield numbers[job], job, [numbers[need] for need in dag.dependencies[job] if need in numbers]


def requested_jobs(workflow: Any) -> list[Any]:
    """Return all jobs of the requested files, also those that are up to date."""
    return [*workflow.dag.jobs]


def newer_inputs(workflow: Any) -> list[str]:
    """Return the existing files that are newer than what was made from them, which is made again."""
    dag = workflow.dag
    reasons = (dag.reason(job) for _, job, _ in planned_jobs(workflow))
    return sorted({file for why in reasons for file in why.updated_input - why.updated_input_run})


def usable_cores(workflow: Any) -> int:
    """Return the number of cores that jobs can use at most: on a cluster it is not limited by this machine."""
    return available_cores() if workflow.local_exec else sys.maxsize


def is_touching(workflow: Any) -> bool:
    """Return whether the run only sets the times of files, which is not worth a display."""
    return workflow.touch
