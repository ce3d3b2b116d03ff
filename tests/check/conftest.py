"""A finished study to damage."""

import json
from pathlib import Path

import pytest

from tests.workflow.conftest import copied


def change_record(results, change):
    """Change the record of a study as with an editor."""
    content = json.loads((results / "study.json").read_text())
    change(content)
    (results / "study.json").write_text(json.dumps(content))


@pytest.fixture
def results(finished, tmp_path, monkeypatch):
    """The results of a copy of the finished study, seen from the folder in which Snakemake ran."""
    monkeypatch.chdir(copied(finished.folder, tmp_path / "study").folder)
    change_record(Path("results/tiny"), lambda record: record.update(arguments="--configfile study.yaml"))
    return Path("results/tiny")
