"""Files are written whole or not at all."""

import pytest

from burridge_knopoff.files import display_path, write_text, write_whole


def test_a_failed_write_leaves_what_was_there(tmp_path):
    path = tmp_path / "result.txt"
    write_text(path, "old")

    def fail(name):
        with open(name, "w") as file:
            file.write("half")
        raise RuntimeError("disk full")

    with pytest.raises(OSError, match=r"result\.txt: cannot be written: disk full"):
        write_whole(path, fail)
    assert path.read_text() == "old"
    assert [item.name for item in tmp_path.iterdir()] == ["result.txt"]


def test_an_interrupted_write_leaves_nothing(tmp_path):
    def interrupt(name):
        open(name, "w").close()
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        write_whole(tmp_path / "result.txt", interrupt)
    assert list(tmp_path.iterdir()) == []


def test_display_path(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert display_path(tmp_path / "config" / "x.yaml") == "config/x.yaml"
    assert display_path("/etc/x.yaml") == "/etc/x.yaml"
