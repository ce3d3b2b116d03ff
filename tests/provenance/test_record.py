"""The study and the commit of a folder of results, also in a worktree and with packed references."""

import json
import subprocess

import pytest

from burridge_knopoff.provenance import record
from burridge_knopoff.provenance.record import check_owner

GIVEN = {"study": "mine", "a": [0.1], "v": 0.1}


def recorded(folder):
    texts = {"software": "", "git_commit": "", "arguments": "", "config_file": "mine.yaml"}
    (folder / "study.json").write_text(json.dumps({**texts, "given": GIVEN, "config": {}, "grid": {}}))


@pytest.mark.parametrize(
    ("config_file", "given"),
    [
        *(("mine.yaml", GIVEN), ("mine.yaml", {**GIVEN, "v": 0.2}), ("./sub/../mine.yaml", {**GIVEN, "v": 0.2})),
        ("moved.yaml", GIVEN),
    ],
)
def test_an_edited_or_moved_config_keeps_its_folder(tmp_path, monkeypatch, config_file, given):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "sub").mkdir()
    recorded(tmp_path)
    check_owner(tmp_path, config_file, given)


def test_another_config_of_the_same_name_is_refused(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    recorded(tmp_path)
    with pytest.raises(ValueError, match="study: got '.*', expected") as error:
        check_owner(tmp_path, "other.yaml", {"study": "mine", "a": [0.1], "window": 9})
    message = str(error.value)
    assert "\n" not in message
    assert "other.yaml: " in message
    assert "results of mine.yaml, which differs (v, window)" in message
    assert f"remove {tmp_path / 'study.json'}" in message
    (tmp_path / "study.json").unlink()
    check_owner(tmp_path, "other.yaml", {})


def test_a_corrupt_record_refuses_no_config(tmp_path):
    (tmp_path / "study.json").write_text("{")
    check_owner(tmp_path, "other.yaml", GIVEN)


def git(folder, *command):
    identity = ("-c", "user.name=test", "-c", "user.email=test@example.org")
    done = subprocess.run(["git", *identity, *command], cwd=folder, capture_output=True, text=True, check=True)
    return done.stdout.strip()


@pytest.fixture
def checkout(tmp_path, monkeypatch):
    """A repository with one commit, whose package folder replaces the real one."""

    def look(folder):
        monkeypatch.setattr(record, "PACKAGE", folder / "src" / "burridge_knopoff")
        record.git_commit.cache_clear()
        return record.git_commit()

    root = tmp_path / "root"
    root.mkdir()
    git(root, "init", "-q")
    git(root, "commit", "-q", "--allow-empty", "-m", "first")
    yield root, look
    record.git_commit.cache_clear()


def test_the_commit_of_a_checkout_a_worktree_and_a_detached_head(checkout):
    root, look = checkout
    commit = git(root, "rev-parse", "HEAD")
    assert look(root) == commit
    git(root, "worktree", "add", "-q", "-b", "other", "../other")
    assert look(root.parent / "other") == commit
    git(root.parent / "other", "commit", "-q", "--allow-empty", "-m", "second")
    second = git(root, "rev-parse", "other")
    assert look(root.parent / "other") == second != commit
    git(root, "pack-refs", "--all")
    assert (look(root), look(root.parent / "other")) == (commit, second)
    git(root, "checkout", "-q", "--detach")
    assert look(root) == commit


def test_changed_files_are_reported(checkout):
    root, look = checkout
    (root / "one.txt").write_text("1")
    # Files that are not under version control, such as results, do not count as changes.
    assert not look(root).endswith("-dirty")
    git(root, "add", "one.txt")
    git(root, "commit", "-q", "-m", "second")
    git(root, "tag", "v1")
    commit = git(root, "rev-parse", "HEAD")
    assert look(root) == commit
    (root / "one.txt").write_text("2")
    assert look(root) == f"{commit}-dirty"


def test_outside_a_checkout_there_is_no_commit(checkout, tmp_path):
    _, look = checkout
    assert look(tmp_path / "elsewhere") == "unknown"
