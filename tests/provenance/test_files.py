"""Files are written completely or not at all."""

import errno
import io
import os
import re
import resource
import signal
import subprocess
import sys
from functools import partial

import pytest

from burridge_knopoff.provenance.files import (
    ROOM,
    check_folder,
    check_target,
    display_path,
    nearest_folder,
    read_regular,
    remove_links,
    reserve_room,
    write_text,
    write_whole,
)
from tests.refused import refused


def test_a_failed_write_keeps_the_previous_file(tmp_path):
    path = tmp_path / "result.txt"
    write_text(path, "old")

    def fail(name):
        with open(name, "w") as file:
            file.write("half")
        raise RuntimeError("NetCDF: HDF error")

    with refused("result.txt", "HDF error", "not full", error=OSError):
        write_whole(path, fail)
    assert path.read_text() == "old"
    assert [item.name for item in tmp_path.iterdir()] == ["result.txt"]


@pytest.mark.parametrize("error", [PermissionError(errno.EACCES, "Permission denied"), RuntimeError("HDF error")])
def test_a_full_disk_is_reported(tmp_path, error):
    """This holds whatever error netCDF4 reports."""

    def fail(name):
        # Writing to this device fails for lack of space.
        os.symlink("/dev/full", name)
        raise error

    with refused("a.nc", "No space left", error=OSError):
        write_whole(tmp_path / "a.nc", fail)


def test_a_disk_with_a_little_room_is_full(tmp_path):
    """Part of the bytes fits, as when another job has just removed its file."""

    def fail(name):
        open(name, "w").close()
        raise RuntimeError("NetCDF: HDF error")

    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (1 << 16, limits[1]))
    try:
        with refused("a.nc", "File too large", error=OSError):
            write_whole(tmp_path / "a.nc", fail)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert list(tmp_path.iterdir()) == []


def test_an_interrupted_write_leaves_nothing(tmp_path):
    def interrupt(name):
        open(name, "w").close()
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        write_whole(tmp_path / "result.txt", interrupt)
    assert list(tmp_path.iterdir()) == []


def leftover(path):
    """Write `path` in a process that is killed just before the file is moved into place; return the names left."""
    process = os.fork()
    if not process:
        write_whole(path, lambda name: (open(name, "w").close(), os.kill(os.getpid(), signal.SIGKILL)))
    os.waitpid(process, 0)
    return {item.name for item in path.parent.iterdir()}


@pytest.mark.parametrize("name", ["a0.0500.nc", "figure.png", "claims", "[a].txt", "a+b.nc"])
def test_the_next_write_removes_leftovers_of_a_killed_writer(tmp_path, name):
    (left,) = leftover(tmp_path / name)
    assert re.fullmatch(rf"\.{re.escape(tmp_path.joinpath(name).stem)}\.part-[0-9a-f]{{8}}(\.\w+)?", left)
    write_text(tmp_path / name, "whole")
    assert [item.name for item in tmp_path.iterdir()] == [name]


def test_temporary_files_of_others_are_kept(tmp_path):
    """The files have similar names, another suffix, or another origin."""
    others = {".a0.05.1.part-0123abcd.nc", ".a0.05.part-0123abcd.pdf", ".a0.05.part-notes.nc", ".a0.05.nc"}
    for name in others:
        (tmp_path / name).touch()
    write_text(tmp_path / "a0.05.nc", "whole")
    assert {item.name for item in tmp_path.iterdir()} == others | {"a0.05.nc"}


def test_two_writers_of_one_file(tmp_path):
    """The first to finish removes the temporary file of the other, which writes once more."""
    path = tmp_path / "a.txt"
    calls = []

    def slow(name):
        calls.append(name)
        with open(name, "w") as file:
            file.write("slow")
        if len(calls) == 1:
            write_text(path, "fast")

    write_whole(path, slow)
    assert len(calls) == 2
    assert path.read_text() == "slow"
    assert [item.name for item in tmp_path.iterdir()] == ["a.txt"]


def test_a_writer_that_makes_no_file(tmp_path):
    with refused("a.txt", error=OSError):
        write_whole(tmp_path / "a.txt", lambda name: None)


def test_folders_that_cannot_be_written_to(tmp_path):
    (tmp_path / "file").touch()
    (tmp_path / "link").symlink_to("nowhere")
    for path in ("file", "link"):
        for below in (path, f"{path}/study"):
            for check in (nearest_folder, check_folder, partial(check_folder, inside=True)):
                with pytest.raises(OSError, match=f"^{re.escape(str(tmp_path / path))} "):
                    check(tmp_path / below)
    with refused("x.nc", str(tmp_path / "file"), error=OSError):
        check_target(tmp_path / "file" / "x.nc")
    assert nearest_folder(tmp_path / "not" / "there") == tmp_path
    check_folder(tmp_path / "not" / "there", inside=True)
    with pytest.raises(OSError, match="^/proc/self "):
        check_folder("/proc/self/results")


def test_a_link_is_replaced(tmp_path):
    """The file to which it points, wherever that is, is neither written nor made."""
    (tmp_path / "elsewhere").mkdir()
    target = tmp_path / "elsewhere/mine.txt"
    target.write_text("mine")
    for name in (target, "elsewhere/mine.txt", "elsewhere/none.txt", "nowhere/none.txt", "link.txt"):
        (tmp_path / "link.txt").unlink(missing_ok=True)
        (tmp_path / "link.txt").symlink_to(name)
        write_text(tmp_path / "link.txt", "whole")
        assert not (tmp_path / "link.txt").is_symlink()
        assert (tmp_path / "link.txt").read_text() == "whole"
        assert target.read_text() == "mine"
    assert {path.name for path in tmp_path.rglob("*")} == {"elsewhere", "mine.txt", "link.txt"}


@pytest.mark.parametrize("target", ["/dev/null", "folder"])
def test_a_link_to_anything_but_a_file_is_refused(tmp_path, target):
    """Otherwise the link /dev/stdout of the system could be replaced."""
    (tmp_path / "folder").mkdir()
    (tmp_path / "link").symlink_to(target)
    with refused(str(tmp_path / "link"), error=OSError):
        write_text(tmp_path / "link", "whole")
    assert (tmp_path / "link").is_symlink()


def test_a_file_in_a_linked_folder_is_written_there(tmp_path):
    """Users keep results on another disk."""
    (tmp_path / "disk").mkdir()
    (tmp_path / "results").symlink_to("disk")
    write_text(tmp_path / "results/a.txt", "whole")
    assert (tmp_path / "disk/a.txt").read_text() == "whole"
    assert (tmp_path / "results").is_symlink()


def test_links_are_removed_and_files_are_kept(tmp_path):
    for name in ("file", "target"):
        (tmp_path / name).write_text(name)
    (tmp_path / "link").symlink_to("target")
    (tmp_path / "broken").symlink_to("nowhere")
    remove_links(*(tmp_path / name for name in ("file", "link", "broken", "none")))
    assert {path.name for path in tmp_path.iterdir()} == {"file", "target"}


def test_display_path(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert display_path(tmp_path / "config" / "x.yaml") == "config/x.yaml"
    assert display_path("/etc/x.yaml") == "/etc/x.yaml"


RESERVES = """
import os, sys
from burridge_knopoff.provenance.files import ROOM, reserve_room
reserve_room(sys.stderr)
print(os.fstat(2).st_size == ROOM, file=sys.stdout)
"""


@pytest.mark.parametrize(
    ("code", "before", "after"),
    [
        ("pass", "", ""),
        ("sys.stderr.write('why')", "", "why"),
        ("sys.stderr.write('x' * 20_000)", "", "x" * 20_000),
        ("raise SystemExit('why')", "", "why\n"),
        # A log of an earlier run is not touched, nor one to which others append.
        ("sys.stderr.write('why')", "earlier", "earlierwhy"),
    ],
)
def test_room_for_the_last_words_is_given_back(tmp_path, code, before, after):
    log = tmp_path / "log"
    log.write_text(before)
    with log.open("a" if before else "w") as stream:
        command = [sys.executable, "-c", f"{RESERVES}{code}"]
        run = subprocess.run(command, stdout=subprocess.PIPE, stderr=stream, text=True, check=False)
    assert (run.stdout, log.read_text()) == (f"{not before}\n", after)


def test_room_of_a_killed_process_is_blank(tmp_path):
    log = tmp_path / "log"
    with log.open("w") as stream:
        code = f"{RESERVES}sys.stderr.write('a warning\\n'); sys.stderr.flush(); os.kill(os.getpid(), 9)"
        subprocess.run([sys.executable, "-c", code], stdout=subprocess.DEVNULL, stderr=stream, check=False)
    assert log.read_text().split() == ["a", "warning"]
    assert len(log.read_text()) == ROOM


def test_streams_that_are_no_files_are_left_alone():
    reserve_room(None)
    reserve_room(io.StringIO())
    with open("/dev/null", "w") as stream:
        reserve_room(stream)


def test_only_regular_files_are_read(tmp_path):
    """A pipe would wait for its writer."""
    (tmp_path / "file").write_bytes(b"abc")
    assert (read_regular(tmp_path / "file"), read_regular(tmp_path / "file", 2)) == (b"abc", b"ab")
    (tmp_path / "link").symlink_to("file")
    assert read_regular(tmp_path / "link") == b"abc"
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "linked").symlink_to("pipe")
    for name, words in (("pipe", "not a regular file"), ("linked", "not a regular file"), (".", "a folder")):
        with pytest.raises(OSError, match=words):
            read_regular(tmp_path / name)
    with pytest.raises(FileNotFoundError):
        read_regular(tmp_path / "none")
