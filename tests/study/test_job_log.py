"""What a failed job said last."""

import pytest

from burridge_knopoff.study.job_log import last_words

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
        # Cut off, as on a full disk.
        (TRACEBACK, ""),
    ],
)
def test_last_words(tmp_path, text, words):
    (tmp_path / "log").write_text(text)
    last = last_words(tmp_path / "log")
    assert last.startswith(words)
    assert bool(last) == bool(words)
    assert "\n" not in last


def test_no_log(tmp_path):
    assert last_words(tmp_path / "log") == ""
