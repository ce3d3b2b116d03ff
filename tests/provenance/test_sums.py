"""SHA256SUMS: texts and pictures are checked against it, and `sha256sum -c` reads it."""

import subprocess
from concurrent.futures import ThreadPoolExecutor

import pytest

from burridge_knopoff.provenance.bad_file import BadFile
from burridge_knopoff.provenance.sums import NAME, add_sums, check_sum, read_sums, write_sums


@pytest.fixture
def results(tmp_path):
    (tmp_path / "summary").mkdir()
    for name in ("summary/b.txt", "summary/a.csv", "summary/a.nc"):
        (tmp_path / name).write_text(f"content of {name}\n")
    add_sums(tmp_path, ["summary/b.txt", "summary/a.csv"])
    return tmp_path


def is_accepted(results):
    run = subprocess.run(["sha256sum", "--check", "--strict", "--quiet", NAME], cwd=results, capture_output=True)
    return run.returncode == 0


def test_a_finished_list_is_read_by_sha256sum(results):
    names = ["summary/a.csv", "summary/a.nc", "summary/b.txt"]
    write_sums(results, [*names[::-1], "summary/missing.txt"])
    assert [*read_sums(results)] == names
    assert is_accepted(results)
    (results / "summary/a.nc").write_text("another\n")
    assert not is_accepted(results)


def test_a_changed_text_is_refused_also_after_the_end_of_a_run(results):
    (results / "summary/b.txt").write_text("changed\n")
    for _ in range(2):
        with pytest.raises(BadFile, match=r"b\.txt: was changed after it was written"):
            check_sum(results, "summary/b.txt")
        # A list of a finished run does not make a changed text the expected one.
        write_sums(results, ["summary/a.csv", "summary/b.txt"])
    check_sum(results, "summary/a.csv")
    assert not is_accepted(results)


@pytest.mark.parametrize(
    ("spoil", "words"),
    [
        (lambda path: path.unlink(), "is missing"),
        (lambda path: path.write_text(""), "is empty"),
        (lambda path: (path.parents[1] / NAME).unlink(), f"has no line in {NAME}"),
        (lambda path: (path.parents[1] / NAME).write_bytes(b"\xff\n\n"), f"has no line in {NAME}"),
        (lambda path: path.write_text((path.parent / "b.txt").read_text()), "was changed after it was written"),
    ],
)
def test_a_bad_text_is_refused(results, spoil, words):
    spoil(results / "summary/a.csv")
    with pytest.raises(BadFile, match=words):
        check_sum(results, "summary/a.csv")


def test_a_text_that_is_made_again_counts(results):
    (results / "summary/b.txt").write_text("made again\n")
    add_sums(results, ["summary/b.txt"])
    check_sum(results, "summary/b.txt")


def test_jobs_that_end_at_the_same_time_lose_no_line(tmp_path):
    names = [f"{n}.txt" for n in range(200)]
    for name in names:
        (tmp_path / name).write_text(name)
    with ThreadPoolExecutor(8) as pool:
        list(pool.map(lambda name: add_sums(tmp_path, [name]), names))
    for name in names:
        check_sum(tmp_path, name)
