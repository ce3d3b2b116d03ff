"""`.ci/run` runs every check, with the programs that the README names and no others."""

import os
import re
import subprocess
import sysconfig
import tomllib
from pathlib import Path

import yaml

from tests.optional import SETTINGS


def test_the_tests_run_with_nothing_but_what_the_readme_names(repository, tmp_path):
    needed = re.search(r"\*\*Requirements\*\*: (.*?)\n\n", (repository / "README.md").read_text(), re.DOTALL)[1]
    names = {name for words in re.findall(r"`(.*?)`", needed) for name in words.split()}
    compiler = Path(sysconfig.get_config_var("CXX").split()[0]).name
    # A replacement for `make` that prints its arguments.
    make = tmp_path / "make"
    make.write_text('#!/usr/bin/env bash\necho "$@"\ncd "$PATH" && echo *\n')
    make.chmod(0o755)
    path = os.pathsep.join((str(tmp_path), os.environ["PATH"]))
    environment = {**os.environ, **dict.fromkeys(SETTINGS, ""), "PATH": path}
    run = subprocess.run([repository / ".ci" / "run"], capture_output=True, text=True, env=environment)
    target, programs = run.stdout.splitlines()
    assert target == "test-all"
    assert set(programs.split()) == names | {compiler}, run.stderr


def test_the_workflow_tests_the_oldest_and_the_newest_python(repository):
    jobs = yaml.safe_load((repository / ".github/workflows/test.yml").read_text())["jobs"]
    project = tomllib.loads((repository / "pyproject.toml").read_text())["project"]
    versions = [name.rpartition(" ")[2] for name in project["classifiers"] if "Python :: 3." in name]
    assert jobs["test"]["strategy"]["matrix"]["python"] == [versions[0], versions[-1]]
    assert project["requires-python"] == f">={versions[0]}"
    assert jobs["test"]["steps"][-1]["run"] == "make test"
