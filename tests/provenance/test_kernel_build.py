"""A kernel compiled from other sources than those on disk is refused."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from burridge_knopoff.provenance import kernel_build
from burridge_knopoff.provenance.sources import PACKAGE

RUN = (
    "from burridge_knopoff import Model, simulate; "
    "print(simulate(Model('linearized', a=0.08), transient=0.0, window=2.0).status)"
)
MODULE = Path("kernel/module.cpp")


@pytest.fixture
def package(tmp_path):
    """A copy of the package with its compiled kernel."""
    subprocess.run(["cp", "-a", str(PACKAGE), str(tmp_path / "burridge_knopoff")], check=True)
    return tmp_path / "burridge_knopoff"


def run(package, code=RUN):
    environment = {**os.environ, "PYTHONPATH": str(package.parent)}
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=environment)


def change(path, code=True):
    comment = "#" if path.suffix == ".py" else "//"
    path.write_text(path.read_text() + ("\nMORE = 1\n" if code else f"\n{comment} more words\n"))


def refusal(package):
    done = run(package)
    assert done.returncode != 0
    return done.stderr.strip().splitlines()[-1]


def test_the_installed_kernel_matches_its_sources():
    kernel_build.check_kernel(compiled=True)
    recorded = json.loads((kernel_build.KERNEL / kernel_build.RECORD).read_text())
    assert recorded == kernel_build.current_build()
    assert {"kernel/__init__.py", str(MODULE), "provenance/compilation.py"} <= recorded["sources"].keys()


def test_an_unchanged_kernel_runs(package):
    assert run(package).stdout == "completed\n"


@pytest.mark.parametrize("name", ["kernel/__init__.py", str(MODULE), "provenance/compilation.py"])
def test_changed_code_is_refused_with_the_command_that_rebuilds(package, name):
    change(package / name)
    rebuild = "run `pip install --force-reinstall burridge-knopoff`"
    expected = f"{name}: has changed since the kernel was compiled: {rebuild}"
    assert refusal(package) == f"burridge_knopoff.provenance.kernel_build.KernelError: {expected}"
    done = run(package, "from burridge_knopoff.cli import main; print(main('simulate --law x --a 1 --out x'.split()))")
    assert done.stdout == "2\n"
    assert done.stderr == f"bk simulate: {expected}\n"


def test_a_changed_comment_is_ignored(package):
    change(package / "kernel/__init__.py", code=False)
    change(package / MODULE, code=False)
    assert run(package).stdout == "completed\n"


@pytest.mark.parametrize("name", ["more.py", "more.h", "more.cpp"])
def test_a_new_source_is_noticed(package, name):
    (package / "kernel" / name).write_text("x = 1\n")
    assert f"kernel/{name}: has changed" in refusal(package)


def test_a_missing_source_is_noticed(package):
    (package / MODULE).unlink()
    assert f"{MODULE}: has changed" in refusal(package)


@pytest.mark.parametrize("content", [None, "", "{", "[1]", "[" * 9999, '{"sources": 1, "instructions": []}'])
def test_a_build_that_was_not_finished_is_refused(package, content):
    path = package / "kernel" / kernel_build.RECORD
    path.unlink() if content is None else path.write_text(content)
    assert "build.json: cannot be read; the kernel was not compiled completely" in refusal(package)


def test_an_uncompiled_kernel_is_refused(package):
    for path in (package / "kernel").glob("*.so"):
        path.unlink()
    done = run(package)
    assert done.stderr.strip().endswith(
        "KernelError: the kernel is not compiled: run `pip install --force-reinstall burridge-knopoff`"
    )


def test_a_kernel_for_a_newer_processor_is_refused_before_it_is_loaded(package):
    """The first instruction that this machine lacks would end Python by a signal, without a message."""
    path = package / "kernel" / kernel_build.RECORD
    record = json.loads(path.read_text())
    (needed,) = record["instructions"].values()
    path.write_text(json.dumps({**record, "instructions": {"": [*needed, "avx1024"]}}))
    reason = "the kernel was compiled for a processor with avx1024, which this one lacks: run `pip install"
    assert reason in refusal(package)
    path.write_text(json.dumps({**record, "instructions": {"": []}}))
    assert run(package).stdout == "completed\n"
