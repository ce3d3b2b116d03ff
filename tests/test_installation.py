"""The package installed without the checkout: a plain installation is sufficient for the library."""

import json
import os
import shutil
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

import pytest

from tests.pages import blocks

pytestmark = pytest.mark.slow

# Subpackages for studies only, which `snakemake` uses from a checkout: the extras `study` and `proof`.
OF_STUDY = ("proof", "report", "summaries.proof")

MODULES = """
import importlib, json, pkgutil, sys
import burridge_knopoff

missing = {}
for module in pkgutil.walk_packages(burridge_knopoff.__path__, "burridge_knopoff."):
    try:
        importlib.import_module(module.name)
    except ModuleNotFoundError as error:
        missing[module.name.removeprefix("burridge_knopoff.")] = error.name
print(json.dumps([burridge_knopoff.__file__, missing]))
"""

WORK = """
from burridge_knopoff import Model, basin_map, simulate, sweep
from burridge_knopoff.figures import basins as basin_figure
from burridge_knopoff.figures.style import write_figure

run = simulate(Model("stribeck", a=0.1), "plus", transient=20, window=50)
run.to_dataset().to_netcdf("run.nc")
assert sweep(Model("nonlinear"), a=[0.1, 0.2], transient=20, window=50).sizes["a"] == 2
maps = basin_map(Model("linearized", a=0.08), pixels=2, samples=4, transient=500, window=500)
write_figure(basin_figure.draw(maps[0], {"plus": (0.989, -0.991)}), "basins.png")
"""


def run(installed, folder, *arguments):
    done = subprocess.run([installed.python, "-I", *arguments], cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


OLD = "#!/bin/sh\necho 'cc1plus: error: unrecognized option -std=c++20' >&2; exit 1\n"


@pytest.mark.parametrize(
    ("program", "reason"),
    [("", "compiler: No such file or directory"), (OLD, "cc1plus: error: unrecognized option -std=c++20")],
)
def test_without_a_compiler_make_says_in_one_line_what_to_install(repository, tmp_path, program, reason):
    compiler = tmp_path / "compiler"
    if program:
        compiler.write_text(program)
        compiler.chmod(0o755)
    command = ["make", "-o", ".venv/build", "kernel", f"BIN={Path(sys.executable).parent}"]
    outside = {key: value for key, value in os.environ.items() if not key.startswith("MAKE")}
    environment = {**outside, "CXX": str(compiler), "LC_ALL": "C"}
    run = subprocess.run(command, cwd=repository, env=environment, capture_output=True, text=True)
    assert run.returncode == 2
    line, end = run.stderr.splitlines()
    assert line.startswith("no working C++20 compiler (")
    assert reason in line
    assert "apt install g++ python3-dev" in line
    assert end.startswith("make: ***")


def test_an_edit_of_a_source_compiles_that_source_alone(repository, tmp_path):
    for name in ("setup.py", "pyproject.toml", "README.md", "LICENSE"):
        shutil.copy(repository / name, tmp_path)
    for name in ("src", "build/objects"):
        shutil.copytree(repository / name, tmp_path / name)
    source = tmp_path / "src/burridge_knopoff/kernel/creep.cpp"
    compiled = {}
    for text in ("// a comment", "int added_by_a_test;"):
        source.write_text(f"{source.read_text()}{text}\n")
        build = [sys.executable, "setup.py", "--quiet", "build_ext", "--inplace", "--force"]
        subprocess.run(build, cwd=tmp_path, check=True, capture_output=True)
        compiled[text] = {path.name: path.stat().st_mtime for path in (tmp_path / "build/objects").iterdir()}
    before, after = compiled.values()
    # A comment changes no code.
    assert set(before) == {path.name for path in (repository / "build/objects").iterdir()}
    assert [name.split("-")[0] for name, time in after.items() if before.get(name) != time] == ["creep"]
    assert len(after) == len(before)


#: Stands for Python: it makes an environment with itself as Python, and logs what it does there.
PYTHON = f"""#!{sys.executable}
import os, shutil, sys
with open("log", "a") as log:
    print(*sys.argv[1:], file=log)
if sys.argv[1:3] == ["-m", "venv"]:
    folder = os.path.abspath(sys.argv[3])
    os.makedirs(f"{{folder}}/bin", exist_ok=True)
    shutil.copy(sys.argv[0], f"{{folder}}/bin/python")
    with open(f"{{folder}}/pyvenv.cfg", "w") as settings:
        print(f"command = python -m venv {{folder}}", file=settings)
"""


@pytest.fixture
def checkout(repository, tmp_path):
    """A checkout that was set up with PYTHON, with an environment for the mutants as well; the sources are linked."""
    folder = tmp_path / "old"
    folder.mkdir()
    for name in ("Makefile", "setup.py", "pyproject.toml", "requirements", "src"):
        (folder / name).symlink_to(repository / name)
    (folder / "python").write_text(PYTHON)
    (folder / "python").chmod(0o755)
    make(folder, "setup", ".venv-mutants/ready")
    return folder


def make(folder, *targets):
    """Run make in a checkout of PYTHON; return what it writes, and what PYTHON logs."""
    outside = {key: value for key, value in os.environ.items() if not key.startswith("MAKE")}
    (folder / "log").write_text("")
    run = subprocess.run(["make", "PYTHON=./python", *targets], cwd=folder, env=outside, capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
    return run.stdout, (folder / "log").read_text()


def test_make_sets_up_once(checkout):
    output, log = make(checkout, "setup", ".venv-mutants/ready")
    assert log == ""
    assert "Next: source .venv/bin/activate" in output


@pytest.mark.parametrize("copied", [False, True])
def test_a_checkout_that_was_moved_or_copied_is_set_up_again(checkout, copied):
    """Its programs would be missing, or run the sources of the other one."""
    moved = checkout.with_name("new")
    if copied:
        shutil.copytree(checkout, moved, symlinks=True)
    else:
        checkout.rename(moved)
    for folder in (".venv", ".venv-mutants"):
        (moved / folder / "bin/snakemake").write_text(f"#!{checkout}/.venv/bin/python\n")
    (moved / ".venvs").mkdir()
    (moved / ".venvs/pyvenv.cfg").write_text(f"home = x\ncommand = python -m venv {moved}/src\n")
    output, log = make(moved, "announce")
    assert "moved" not in output
    assert (moved / ".venv/bin/snakemake").exists()
    output, log = make(moved, "setup", ".venv-mutants/ready")
    (line,) = [line for line in output.splitlines() if "moved or copied" in line]
    assert {".venv", ".venv-mutants"} < {*line.split()}
    assert "-m venv .venv\n" in log
    assert "--editable ." in log
    for folder in (".venv", ".venv-mutants"):
        assert (moved / folder / "bin/python").exists()
        assert not (moved / folder / "bin/snakemake").exists()
    # Only what make makes is made again.
    assert (moved / ".venvs/pyvenv.cfg").exists()
    assert (moved / "src/burridge_knopoff").is_dir()
    assert make(moved, "setup", ".venv-mutants/ready")[1] == ""
    if copied:
        assert make(checkout, "setup", ".venv-mutants/ready")[1] == ""


def test_an_environment_of_another_program_is_left_alone(checkout):
    """That of uv or virtualenv does not tell where it was made."""
    (checkout / ".venv/pyvenv.cfg").write_text("home = /usr/bin\nuv = 0.5\n")
    assert make(checkout, "setup")[1] == ""


def test_building_for_another_environment_touches_nothing_in_the_tree(installed):
    """This includes its kernel, which a running study may use, and the record of its build."""
    assert installed.touched == []


def test_all_subpackages_except_those_of_a_study_can_be_imported(installed, tmp_path):
    where, missing = json.loads(run(installed, tmp_path, "-c", MODULES))
    assert where.startswith(str(installed.folder / "environment"))
    assert [name for name in missing if not name.startswith(OF_STUDY)] == []


def test_the_python_of_the_page_on_results_runs(installed, tmp_path, repository):
    # The other blocks read the files of a study.
    texts = [
        block.text
        for block in blocks((repository / "docs/results.md").read_text())
        if (block.info, block.heading) == ("python", "A single run")
    ]
    assert texts
    for text in texts:
        run(installed, tmp_path, "-c", text)


def test_runs_basins_and_figures_work(installed, tmp_path):
    run(installed, tmp_path, "-c", WORK)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["basins.png", "run.nc"]


def test_the_command_works(installed, tmp_path):
    command = "import sys; from burridge_knopoff.cli import main; sys.exit(main())"
    arguments = "simulate --law linearized --a 0.08 --transient 10 --window 20 --out run.nc"
    run(installed, tmp_path, "-c", command, *arguments.split())
    assert (tmp_path / "run.nc").is_file()


@pytest.mark.parametrize(
    "name",
    ["kernel/module.cpp", "kernel/_core.pyi", "report/templates/laws.jinja", "py.typed", "__init__.pyi"],
)
def test_both_distributions_contain(installed, name):
    assert f"burridge_knopoff/{name}" in zipfile.ZipFile(installed.wheel).namelist()
    with tarfile.open(installed.source) as archive:
        names = archive.getnames()
    assert any(item.endswith(f"/src/burridge_knopoff/{name}") for item in names)
    assert not [item for item in names if item.endswith(".so") or "/tests/" in item]
