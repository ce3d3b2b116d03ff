"""The study and the commit of a folder of results, also in a worktree and with packed references."""

import json
import os
import shlex
import subprocess

import pytest

from burridge_knopoff.provenance import record
from burridge_knopoff.provenance.record import check_owner, read_study_record, remake_command
from tests.refused import refused

GIVEN = {"study": "mine", "a": [0.1], "v": 0.1}


def recorded(folder, **keys):
    texts = {"software": "", "git_commit": "", "arguments": "", "config_file": "mine.yaml"}
    (folder / "study.json").write_text(json.dumps({**texts, "given": GIVEN, "config": {}, "grid": {}, **keys}))


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
    with refused("study") as error:
        check_owner(tmp_path, "other.yaml", {"study": "mine", "a": [0.1], "window": 9})
    message = str(error.value)
    assert "\n" not in message
    assert "other.yaml: " in message
    assert "results of mine.yaml, which differs (v, window)" in message
    assert f"remove {tmp_path / 'study.json'}" in message
    (tmp_path / "study.json").unlink()
    check_owner(tmp_path, "other.yaml", {})


WORDS = [
    [],
    ["--configfile", "study.yaml"],
    ["-s", "../other/Snakefile", "--configfile", "my study; touch evil.yaml", "--config", "a=[0.1]", "v=$(touch evil)"],
    ["--config", "study=`touch evil`", "initial={minus: {}}"],
]


def of_checkout(words, folder):
    """Return the words of a command that runs no Snakefile and no profile of others."""
    checkout = os.path.relpath(record.CHECKOUT, folder)
    if "-s" in words:
        return ["-s", "SNAKEFILE", "--workflow-profile", "none", *words[2:]]
    return ["-s", f"{checkout}/Snakefile", "--workflow-profile", f"{checkout}/profiles/default", *words]


@pytest.mark.parametrize("words", WORDS)
def test_the_recorded_words_are_those_of_the_command(tmp_path, monkeypatch, words):
    """A shell passes them on as they are, and runs nothing."""
    results = tmp_path / "results/mine"
    results.mkdir(parents=True)
    monkeypatch.chdir(tmp_path)
    recorded(results, arguments=shlex.join(words))
    assert read_study_record(results)["arguments"] == words
    line = remake_command(results / "a.nc", is_own_run=True)
    assert shell(line, tmp_path) == ["-c2", *words, "-R", "results/mine/a.nc"]
    line = remake_command(results / "study.json", listed=["echo", "a.nc", "b.nc"])
    assert shell(line, tmp_path) == ["-c2", *of_checkout(words, tmp_path), "-R", "a.nc", "b.nc"]


def test_the_command_names_the_snakefile_of_this_checkout_unless_it_runs_there(tmp_path, monkeypatch):
    checkout, results = tmp_path / "checkout", tmp_path / "checkout/results/mine"
    results.mkdir(parents=True)
    (checkout / "Snakefile").touch()
    monkeypatch.setattr(record, "CHECKOUT", checkout)
    recorded(results, arguments="--config v=0.2")
    monkeypatch.chdir(checkout)
    assert remake_command(results / "a.nc") == "snakemake -c2 --config v=0.2 -R results/mine/a.nc"
    other = tmp_path / "other/results/mine"
    other.mkdir(parents=True)
    monkeypatch.chdir(tmp_path / "other")
    # From a folder without a Snakefile the run named that of the checkout.
    for named in ("", "-s ../checkout/Snakefile ", "-s ../checkout/workflow/Snakefile "):
        recorded(other, arguments=f"{named}--config v=0.2")
        assert remake_command(other / "a.nc") == (
            "snakemake -c2 -s ../checkout/Snakefile --workflow-profile ../checkout/profiles/default --config v=0.2 "
            "-R results/mine/a.nc"
        )


def shell(line, folder):
    """Return the arguments that a shell gives `snakemake`; nothing else is run."""
    done = subprocess.run(
        ["bash", "-c", f"snakemake() {{ printf '%s\\0' \"$@\"; }}; {line}"], cwd=folder, capture_output=True, check=True
    )
    assert not (folder / "evil").exists()
    return [os.fsdecode(word) for word in done.stdout.split(b"\0")[:-1]]


@pytest.mark.parametrize(
    "arguments",
    [
        "; touch evil ;",
        "$(touch evil)",
        "--configfile study.yaml ; touch evil",
        "--configfile study.yaml --executor touch",
        "--configfile --wrapper-prefix=evil",
        "--configfile",
        "-s results/mine/evil.smk",
        "-s ./results/../results/mine/evil.smk",
        "-s --snakefile=evil",
        "--snakefile evil",
        "--config a=1 --touch",
        "--config touch",
        "'unbalanced",
        "-F",
    ],
)
def test_a_record_with_other_arguments_than_a_run_has_is_refused(tmp_path, monkeypatch, arguments):
    results = tmp_path / "results/mine"
    results.mkdir(parents=True)
    monkeypatch.chdir(tmp_path)
    recorded(results, arguments=arguments)
    with refused("study.json"):
        read_study_record(results)
    assert remake_command(results / "a.nc", is_own_run=True) == "snakemake -c2 -R results/mine/a.nc"


def test_the_owner_of_a_folder_is_named_without_control_characters(tmp_path):
    recorded(tmp_path, config_file="mine\x1b[2J\u202e.yaml\nbk: all is well")
    with refused("study") as error:
        check_owner(tmp_path, "other.yaml", {"study": "mine"})
    assert str(error.value).isprintable()


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
