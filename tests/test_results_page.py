"""results/README.md: the files that it names are those of a study, and git tracks nothing else there."""

import re
import subprocess

import pytest

from burridge_knopoff.provenance.record import NAME
from burridge_knopoff.study.load import load_study
from burridge_knopoff.study.yaml_file import read_yaml
from tests.workflow.planned import planned


@pytest.mark.slow
def test_the_page_names_files_of_the_default_study(repository):
    config = read_yaml(repository / "config/paper.yaml")
    study = load_study(config, "paper.yaml")
    paths = {*planned(config).files, NAME, f"points/{study.point_file.replace('{a}', '<value>')}"}
    text = (repository / "results/README.md").read_text(encoding="utf-8")
    named = re.findall(r"`((?:summary|figures|points)/\S+|\w+\.(?:html|json))`", text)
    assert len(named) > 10
    assert {name.replace("<law>", "{law}").replace("<initial>", "{initial}") for name in named} <= paths


def test_git_tracks_the_page_alone(repository):
    if not (repository / ".git").exists():
        pytest.skip("not a git checkout")
    git = ["git", "-C", str(repository), "-c", "safe.directory=*"]
    ignored = ["results/paper/report.html", "results/paper/README.md", "results/x", "workflow/results/README.md"]
    process = subprocess.run([*git, "check-ignore", "results/README.md", *ignored], capture_output=True, text=True)
    assert process.stdout.split() == ignored
