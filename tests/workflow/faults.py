"""Faults that a study must survive: killed, interrupted and broken jobs, full and read-only disks."""

from __future__ import annotations

import base64
import contextlib
import ctypes
import os
import re
import subprocess
import tempfile
import time
from collections.abc import Callable, Collection, Iterator, Mapping
from pathlib import Path

import psutil

from tests.workflow.conftest import Study
from tests.workflow.snakemake import Fork

#: Folders of results/<study> that are compared byte by byte.
COMPARED = ("points", "summary", "figures", "attractors", "basins", "phases", "solvers")
#: The file that is being made when a kill hits a stage.
STAGES = ("points", "attractors", "basins", "solvers", "summary", "figures", "claims", "report")
#: Touched when Snakemake is started.
BEGUN = "begun"
#: Time after which a snakemake without progress counts as stuck.
PATIENCE = 300.0
# Flags of Linux's mount(2) and umount2(2).
READ_ONLY, REMOUNT, BIND, DETACH = 1, 32, 4096, 2


def stage(path: str) -> str:
    """Return the stage that makes a file, given below results/<study>."""
    return "claims" if path.startswith("summary/claims.") else path.split("/")[0].removesuffix(".html")


def running(study: Study) -> list[str]:
    """Return the files, below results/<study>, that jobs are making: those that the last run noted as incomplete."""
    folder = study.folder / ".snakemake" / "incomplete"
    begun = (study.folder / BEGUN).stat().st_mtime_ns
    names = []
    for path in folder.rglob("*"):
        # Snakemake may be removing these records.
        with contextlib.suppress(FileNotFoundError):
            if path.is_file() and path.stat().st_mtime_ns > begun:
                names.append(base64.urlsafe_b64decode(path.name).decode().split("/", 2)[2])
    return sorted(names)


def stages_running(study: Study) -> set[str]:
    """Return the stages of the files that jobs are making, or were making when the run was killed."""
    return {stage(path) for path in running(study)}


def temporaries(study: Study) -> list[str]:
    """Return the files in results/ that have not been moved into place."""
    results = study.folder / "results"
    return sorted(str(path.relative_to(results)) for path in results.rglob(".*.part-*"))


def processes(study: Study) -> dict[int, str]:
    """Return {number: command} of the processes that run in the folder of a study."""
    commands = {}
    for process in psutil.process_iter():
        with contextlib.suppress(psutil.Error, OSError):
            if Path(process.cwd()) == study.folder:
                commands[process.pid] = " ".join(process.cmdline())
    return commands


def begin(study: Study, *arguments: str, environment: Mapping[str, str] | None = None) -> subprocess.Popen[bytes]:
    """Start Snakemake in its own process group, with its output in the file `screen`."""
    (study.folder / BEGUN).touch()
    with (study.folder / "screen").open("wb") as screen:
        return subprocess.Popen(
            study.command(*arguments),
            cwd=study.folder,
            start_new_session=True,
            stdout=screen,
            stderr=subprocess.STDOUT,
            env={**study.environment(), **(environment or {})},
        )


def begin_fork(study: Study) -> Fork:
    """Do the same in forks of processes that have imported what Snakemake and its scripts need."""
    (study.folder / BEGUN).touch()
    screen = study.folder / "screen"
    return Fork(study.command(), study.folder, study.environment(), screen, screen, own_group=True)


def wait_for(
    condition: Callable[[], object], process: subprocess.Popen[bytes] | Fork | None = None, interval: float = 0.05
) -> bool:
    """Wait until a condition holds, at which one looks at intervals; return False if the process ended before."""
    end = time.monotonic() + PATIENCE
    while not condition():
        if process is not None and process.poll() is not None:
            return bool(condition())
        if time.monotonic() > end:
            raise TimeoutError(f"not within {PATIENCE:g} s")
        time.sleep(interval)
    return True


def wait_for_stages(study: Study, stages: Collection[str], process: subprocess.Popen[bytes] | Fork) -> bool:
    """Wait until a job of one of the stages runs; return False if the process ended before."""
    # The jobs of some stages take a few hundredths of a second.
    return wait_for(lambda: not stages_running(study).isdisjoint(stages), process, interval=0.005)


def flag_named(text: str) -> str:
    """Return the flag of Snakemake that its own error message names."""
    named = re.search(r"with the (--[a-z-]+) argument", " ".join(text.split()))
    assert named, text
    return named[1]


def resume(study: Study, *arguments: str) -> list[str]:
    """Run the command again, with the flag that its own error message names, if any; return the flags used."""
    run = study.run(*arguments)
    if run.returncode == 0:
        return []
    flag = flag_named(run.stderr)
    study.ok(flag)
    study.ok(*arguments)
    return [flag]


def failures(text: str) -> dict[str, str]:
    """Return {log below results/<study>/logs: reason} from the lines in which a run reports its failures."""
    assert re.search(r"^study \w+: stopped", text, re.MULTILINE), text
    matches = re.findall(r"^failed: (.+?): (.*) \(log results/\w+/logs/(\S+)\)$", text, re.MULTILINE)
    reasons = {job: reason for job, reason, _ in matches}
    same = "for the same reason as "
    return {log: reasons.get(reason.removeprefix(same), reason) for _, reason, log in matches}


def remedies(text: str) -> list[str]:
    """Return the commands in the closing lines of a run that recreate bad files."""
    return re.findall(r"^this command recreates the bad files and continues: (.+)$", text, re.MULTILINE)


def differences(study: Study, other: Study, *folders: str) -> list[str]:
    """Return the files in which two studies differ, and temporary files."""
    mine, theirs = (tree.files(*(folders or COMPARED)) for tree in (study, other))
    if not folders:
        pages = (next((tree.folder / "results").glob("*/report.html")) for tree in (study, other))
        mine["report.html"], theirs["report.html"] = map(without_times, pages)
    return sorted(name for name in mine.keys() | theirs.keys() if mine.get(name) != theirs.get(name))


def without_times(path: Path) -> bytes:
    """Return the content of a file, of a report without its section on the seconds and the memory of jobs."""
    content = path.read_bytes()
    if path.name != "report.html":
        return content
    whole, count = re.subn(rb'<section id="run-time".*?</section>', b"", content, flags=re.DOTALL)
    assert count == 1
    return whole


def check_end(study: Study, other: Study, *targets: str, folders: Collection[str] = ()) -> None:
    """Require that a run resumes without a flag, ends with the files of another study, and leaves no others."""
    assert resume(study, *targets) == []
    assert differences(study, other, *folders) == []
    assert temporaries(study) == []


def broken(study: Study, faults: Mapping[str, str]) -> dict[str, str]:
    """Return the environment in which each Python process first runs the code of a key that its command contains.

    A script runs the code of a key that the name of its log contains, when it opens that.
    """
    folder = study.folder / "faults"
    folder.mkdir()
    text = f"""
import os, signal, sys
faults = {dict(faults)!r}
def begin(words):
    for key in [key for key in faults if key in words]:
        exec(faults.pop(key), globals())
sys.addaudithook(lambda event, values: event == "open" and values[1] == "w" and begin(str(values[0])))
begin(" ".join(sys.orig_argv))
"""
    (folder / "sitecustomize.py").write_text(text)
    return {"PYTHONPATH": os.pathsep.join([str(folder), study.environment()["PYTHONPATH"]])}


def killed_at_the_move(suffix: str) -> str:
    """Return code that kills its process, as the kernel does if memory runs out, before a file takes its final name."""
    return f"""
replace = os.replace
def killed(source, target):
    if str(target).endswith({suffix!r}):
        os.kill(os.getpid(), signal.SIGKILL)
    replace(source, target)
os.replace = killed
"""


def failing_points(errors: Mapping[str, str]) -> str:
    """Return code that raises an error where a point is written, given by the end of its path."""
    return f"""
import burridge_knopoff.dataset.simulated_point as module
write_point = module.write_point
def provoked(trajectory, path):
    for name, error in {errors!r}.items():
        if str(path).endswith(name):
            raise eval(error)
    write_point(trajectory, path)
module.write_point = provoked
"""


def crash(module: str, function: str) -> str:
    """Return code that breaks a function of the package."""
    return f"""
import {module} as module
def provoked(*arguments, **options):
    raise RuntimeError("provoked\\nin two lines")
module.{function} = provoked
"""


def out_of_memory(module: str, function: str) -> str:
    """Return code that leaves a function of the package only memory in free blocks of less than 16 KiB."""
    return f"""
import netCDF4, {module} as module
function = module.{function}
def starved(*arguments, **options):
    import resource
    resource.setrlimit(resource.RLIMIT_AS, (1, 1))
    taken, size = [], 1 << 24
    while size > 1 << 13:
        try:
            taken.append(bytearray(size))
        except MemoryError:
            size //= 2
    return function(*arguments, **options)
module.{function} = starved
"""


def no_mounts() -> str:
    """Return why no file system can be mounted here, or an empty text."""
    if os.geteuid():
        return "only root can mount a small or a read-only disk"
    with tempfile.TemporaryDirectory() as folder:
        try:
            _mount("tmpfs", Path(folder))
        except OSError as error:
            return f"no file system can be mounted: {error.strerror}"
        _unmount(Path(folder))
    return ""


@contextlib.contextmanager
def small_disk(folder: Path, free: int) -> Iterator[Path]:
    """Put a folder of results on a disk with so many bytes left; yield the file whose removal makes room."""
    subprocess.run(["cp", "-a", str(folder), f"{folder}.kept"], check=True)
    _mount("tmpfs", folder, options="size=64m")
    try:
        subprocess.run(["cp", "-a", f"{folder}.kept/.", str(folder)], check=True)
        disk = os.statvfs(folder)
        ballast = folder / "ballast"
        with ballast.open("wb") as file:
            os.posix_fallocate(file.fileno(), 0, disk.f_bavail * disk.f_frsize - free)
        yield ballast
    finally:
        subprocess.run(["rm", "-rf", f"{folder}.kept"], check=True)
        _unmount(folder)


@contextlib.contextmanager
def read_only(folder: Path) -> Iterator[None]:
    """Make a folder read-only, even for root."""
    _mount(str(folder), folder, BIND)
    try:
        _mount("", folder, BIND | REMOUNT | READ_ONLY)
        yield
    finally:
        _unmount(folder)


def _mount(source: str, folder: Path, flags: int = 0, options: str = "") -> None:
    """Mount a source, or a file system of that type, on a folder; raises OSError."""
    _checked("mount", source.encode(), os.fsencode(folder), source.encode(), ctypes.c_ulong(flags), options.encode())


def _unmount(folder: Path) -> None:
    """Unmount a folder, also if a process still uses it; raises OSError."""
    _checked("umount2", os.fsencode(folder), DETACH)


def _checked(function: str, *arguments: object) -> None:
    """Call a function of the C library that returns 0 or sets errno, so that no program has to be installed."""
    if ctypes.CDLL(None, use_errno=True)[function](*arguments):
        raise OSError(ctypes.get_errno(), os.strerror(ctypes.get_errno()))
