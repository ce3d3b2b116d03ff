"""The last words of a failed job in its log."""

import shutil

import pytest

from burridge_knopoff.running.processes import parallel_map
from burridge_knopoff.study.job_log import SILENT, bad_files, failure_line, logged_error, progress_of

TRACEBACK = """Traceback (most recent call last):
  File "a.py", line 3, in <module>
    run()
    ^^^^^
"""


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", ""),
        ("\n \n", ""),
        ("a warning\nbk simulate: a.nc: cannot be written: No space left on device\n", "bk simulate: a.nc: cannot be"),
        (TRACEBACK + "ValueError: wrong\n", "ValueError: wrong"),
        (TRACEBACK + "ValueError: wrong\n\nin two\n  lines\n", "ValueError: wrong in two lines"),
        (TRACEBACK + "KeyError: 'a'\n\nDuring handling:\n\n" + TRACEBACK + "burridge_knopoff.x.Bad: b", "b"),
        ("note: 30 were kept\n", ""),
        ("ValueError: wrong\nnote: 30 were kept\n", "ValueError: wrong"),
        # Truncated, as on a full disk.
        (TRACEBACK, ""),
    ],
)
def test_logged_error(tmp_path, text, words):
    (tmp_path / "log").write_text(text)
    last = logged_error(tmp_path / "log")
    assert last.startswith(words)
    assert bool(last) == bool(words)
    assert "\n" not in last


def test_the_command_that_recreates_a_bad_file_is_not_part_of_the_reason(tmp_path):
    """Seven jobs may stop at one file: each reason is listed, the command only once."""
    # The reason may quote what somebody wrote into the file.
    (tmp_path / "log").write_text(TRACEBACK + "ValueError: a.nc: is empty; remake it: snakemake -c2 -R a.nc\n")
    reason = "got '; remake it: touch evil -R b.nc', expected c.nc"
    (tmp_path / "quoted").write_text(TRACEBACK + f"ValueError: d.nc: {reason}; remake it: snakemake -c2 -R d.nc\n")
    (tmp_path / "cut").write_text(TRACEBACK + "ValueError: d.nc: is empty; remake it: snakemake -c2 -R 'd.nc\n")
    (tmp_path / "other").write_text(TRACEBACK + "ValueError: wrong\n")
    assert logged_error(tmp_path / "log") == "ValueError: a.nc: is empty"
    logs = [tmp_path / name for name in ("log", "quoted", "cut", "other", "log")]
    assert bad_files(logs) == ["a.nc", "d.nc"]


def test_the_progress_of_a_long_job_is_not_the_reason_of_its_failure(tmp_path, caplog):
    caplog.set_level("INFO")
    with parallel_map(1, tmp_path / "kept") as apply:
        apply("doubled", abs, [1, 2])
    (tmp_path / "log").write_text(f"{caplog.messages[0]}\n")
    assert logged_error(tmp_path / "log") == ""


def test_no_log(tmp_path):
    assert logged_error(tmp_path / "log") == ""


@pytest.mark.parametrize(("free", "words"), [(0, "no space left on its disk"), (10**9, "it was killed")])
def test_a_job_with_an_empty_log(tmp_path, monkeypatch, free, words):
    monkeypatch.setattr(shutil, "disk_usage", lambda path: shutil._ntuple_diskusage(10**9, 10**9 - free, free))
    log = tmp_path / "not there" / "log"
    assert words in failure_line("simulate", [log])
    assert failure_line("simulate", []) == f"failed: simulate: {SILENT} (log none)"


@pytest.mark.parametrize(
    ("texts", "share"),
    [
        ([], 0.0),
        (["", "progress 0.2\nfollowed: 3, 0.1 s, the longest 0.1 s\nprogress 0.311\n"], 0.311),
        (["no progress 0.9 at all\n"], 0.0),
        (["progress 0.9"], 0.9),
    ],
)
def test_the_progress_of_a_running_job(tmp_path, texts, share):
    logs = [tmp_path / str(number) for number in range(len(texts))]
    for log, text in zip(logs, texts, strict=True):
        log.write_text(text)
        # It reports no failure.
        assert logged_error(log) in ("", text.strip()) if "no progress" in text else logged_error(log) == ""
    assert progress_of([*logs, tmp_path / "absent"]) == share
