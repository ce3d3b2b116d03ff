"""Scripts of rules in forks: they see what Snakemake's own way gives them, and their benchmarks miss nothing."""

import json
import os
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

from burridge_knopoff.report.stages import job_costs
from burridge_knopoff.script_server import ScriptServer
from snakemake_logger_plugin_study.internals import script_in_fork
from tests.conftest import quick_first
from tests.workflow.snakemake import SOURCES, run_snakemake

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="elsewhere Snakemake runs all scripts")

#: The scripts of one of two folders run in forks.
SNAKEFILE = """
from pathlib import Path
from burridge_knopoff.script_server import ScriptServer
from snakemake_logger_plugin_study import internals
script = internals.script_in_fork(workflow, script, ScriptServer(), Path("forked").resolve())
rule all:
    input: "forked.json", "own.json"
"""
RULE = """
rule {name}:
    output: "{name}.json"
    log: "{name}.log"
    benchmark: "{name}.tsv"
    threads: 2
    params: config={{"v": 0.1}}, sources="script.py 0123"
    script: "{name}/script.py"
"""

#: Most of its work is done by processes that end between two samples.
SCRIPT = """
import json, os, sys, tempfile, time
for _ in range(4):
    if not os.fork():
        while time.process_time() < 0.15:
            pass
        os._exit(0)
    os.wait()
names = ("input", "params", "threads", "wildcards", "resources", "config", "bench_iteration")
job = {name: str(getattr(snakemake, name)) for name in names}
job |= {name: value for name, value in os.environ.items() if name.endswith("_NUM_THREADS") or name.startswith("T")}
with open(snakemake.output[0], "w") as file:
    json.dump([{**job, "folder": tempfile.gettempdir(), "name": __name__}, sum(os.times()[:4])], file)
"""


@pytest.fixture
def folder(tmp_path):
    """A workflow with the same script in the two folders."""
    (tmp_path / "Snakefile").write_text(SNAKEFILE + RULE.format(name="forked") + RULE.format(name="own"))
    for name in ("forked", "own"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "script.py").write_text(SCRIPT)
    return tmp_path


def run(folder, *arguments):
    return run_snakemake(["snakemake", "-c2", *arguments], folder, {**os.environ, "PYTHONPATH": str(SOURCES)})


@pytest.mark.slow
def test_a_script_sees_the_same_in_both_ways_and_all_cpu_time_is_measured(folder):
    assert run(folder).returncode == 0
    (forked, used), (own, _) = (json.loads((folder / f"{name}.json").read_text()) for name in ("forked", "own"))
    assert forked == own
    assert (own["OMP_NUM_THREADS"], own["name"]) == ("2", "__main__")
    # Snakemake writes down the scripts that it runs.
    assert (folder / ".snakemake/scripts").is_dir()
    ((wall, cpu, memory),) = job_costs(folder / "forked.tsv")
    # Written with two digits.
    assert 0.6 <= used <= cpu + 0.02
    assert cpu < used + 0.3
    assert wall > 0.5
    assert memory > 10.0


@pytest.mark.slow
def test_only_forks_run_the_scripts_of_the_folder(folder):
    assert run(folder, "forked.json").returncode == 0
    assert not (folder / ".snakemake/scripts").exists()


@pytest.mark.parametrize("words", quick_first(["1/0", "import os, signal; os.kill(os.getpid(), signal.SIGKILL)"], 1))
def test_a_script_that_fails_or_is_killed_fails_its_job_alone(folder, words):
    script = folder / "forked/script.py"
    script.write_text(f"{SCRIPT}\n{words}\n")
    end = run(folder, "--keep-going")
    assert end.returncode == 1
    assert (folder / "own.json").exists()
    # Snakemake removes what a failed job has made.
    assert not (folder / "forked.json").exists()
    script.write_text(SCRIPT)
    assert run(folder).returncode == 0


def test_a_rule_without_sources_or_another_interface_is_left_to_snakemake(tmp_path):
    """Nothing is asked of the server."""
    calls, server = [], ScriptServer()
    workflow = SimpleNamespace(remote_exec=False)

    def script(path, basedir, other):
        calls.append((path, basedir, other))

    script_in_fork(workflow, script, server, Path(tmp_path))("script.py", tmp_path, 3)
    assert calls == [("script.py", tmp_path, 3)]
    assert server.pid == 0


def test_on_a_cluster_the_cpu_time_is_that_of_the_processes_of_the_job():
    record = SimpleNamespace(cpu_time=0.0)

    def script(bench_record):
        if not (process := os.fork()):
            sum(range(5_000_000))
            os._exit(0)
        used = os.wait4(process, 0)[2]
        seconds.append(used.ru_utime + used.ru_stime)

    seconds = []
    script_in_fork(SimpleNamespace(remote_exec=True), script, ScriptServer(), Path())(record)
    assert record.cpu_time == pytest.approx(seconds[0], abs=1e-5)
    assert seconds[0] > 0.01
