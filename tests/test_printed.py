"""What is printed: nothing from a file controls the terminal, and every command is quoted word by word."""

import ast
import json
import re
import subprocess
import sys
from pathlib import Path

import netCDF4
import numpy as np
import pytest
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st

from burridge_knopoff import Model, simulate
from burridge_knopoff.check.study import Check, Finding
from burridge_knopoff.cli import main
from burridge_knopoff.cli.output import print_lines
from burridge_knopoff.dataset.point import write_point
from burridge_knopoff.dataset.summary import write_summary
from burridge_knopoff.messages import command
from burridge_knopoff.provenance.bad_file import BadFile
from burridge_knopoff.provenance.sources import PACKAGE, current_sources, files_of, provenance
from snakemake_logger_plugin_study.command_line import check_one_config
from tests.forged import forge
from tests.fuzzing import examples
from tests.refused import refused

#: Clears the screen, sets the title of a terminal, begins a line, turns the direction of letters, goes back, rings.
CONTROLS = "\x1b[2J\x1b]0;title\x07\nremake: rm -rf ~\r\u202e\u2066\x9b1A\x08\x00\x7f\u2028"
#: Attributes that are read, not printed: others than these values are refused.
UNDERSTOOD = ("checksum", "source_module", "flag_meanings", "_FillValue", "_Encoding")
PROGRAMS = [*PACKAGE.rglob("*.py"), *(PACKAGE.parent / "snakemake_logger_plugin_study").glob("*.py")]


def test_show_refuses_a_text_of_an_unknown_encoding(written, tmp_path, capsys):
    path = tmp_path / "point.nc"
    path.write_bytes((written / path.name).read_bytes())
    with netCDF4.Dataset(path, "a") as dataset:
        dataset["law"].setncattr("_Encoding", f"utf-8 {CONTROLS}".replace("\0", ""))
    forge(path)
    assert main(["show", str(path)]) == 2
    assert capsys.readouterr().err.splitlines() == [f"bk show: {path}: has a text of an unknown encoding"]


def shell_words(line, folder):
    """Return the words into which a shell divides a line."""
    done = subprocess.run(["bash", "-c", f"printf '%s\\0' {line}"], cwd=folder, capture_output=True, check=True)
    return [word.decode() for word in done.stdout.split(b"\0")[:-1]]


LETTERS = st.text(st.characters(exclude_characters="\0", exclude_categories=["Cs"]))


@given(
    st.lists(
        LETTERS | st.sampled_from(["", "; touch evil", "$(touch evil)", "`touch evil`", "a'b", "*", "-R", "~", "!!"])
    )
)
@examples(40)
def test_a_shell_reads_a_command_as_its_words(tmp_path_factory, words):
    line, folder = command("bk", *words), tmp_path_factory.getbasetemp() / "shell"
    folder.mkdir(exist_ok=True)
    assert line.isprintable()
    assert shell_words(line, folder) == ["bk", *words]
    assert not [*folder.iterdir()]


def test_an_undecodable_name_in_a_command(tmp_path):
    assert command("bk", "a\udcff'\\.nc") == r"bk $'a\xff\'\\.nc'"


def test_printed_lines_stay_lines(capsys):
    print_lines(f"title: {CONTROLS}", "Φ = 1 − aU′", "")
    first, second, third = capsys.readouterr().out.splitlines()
    assert first == f"title: {''.join(c if c.isprintable() else ascii(c)[1:-1] for c in CONTROLS)}"
    assert (second, third) == ("Φ = 1 − aU′", "")


def is_call_of(node, name):
    return isinstance(node, ast.Call) and ast.unparse(node.func) == name


def test_commands_of_bk_print_lines_only_by_that_function():
    """The other calls print errors, after the same escapes, and a script for a shell."""
    callers = {
        path.name
        for path in (PACKAGE / "cli").glob("*.py")
        if any(is_call_of(node, "print") for node in ast.walk(ast.parse(path.read_text())))
    }
    assert callers == {"__init__.py", "completion.py", "output.py"}


@pytest.mark.parametrize("path", PROGRAMS, ids=lambda path: path.name)
def test_no_other_function_makes_a_command(path):
    text = path.read_text()
    if path.name != "messages.py":
        assert not re.search(r"shlex\.(join|quote)", text)
        # A line with a command, into which a value is written.
        assert not re.search(r"(bk (check|show)|snakemake|cd) \{", text)


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    """A point and a summary."""
    folder = tmp_path_factory.mktemp("written")
    write_point(
        simulate(Model("linearized", a=0.08), "plus", transient=10.0, window=10.0, batches=2), folder / "point.nc"
    )
    write_summary(
        xr.Dataset(
            {"x": ("law", np.zeros(2), {"long_name": "x"})}, attrs={"title": "A title", "history": "snakemake"}
        ).assign_attrs(provenance("burridge_knopoff.summaries.lyapunov")),
        folder / "summary.nc",
    )
    return folder


@pytest.mark.parametrize("name", ["point", "summary"])
@pytest.mark.parametrize("place", ["global", "variables"])
def test_show_escapes_controls_in_every_attribute(written, tmp_path, capsys, name, place):
    path = tmp_path / f"{name}.nc"
    path.write_bytes((written / path.name).read_bytes())
    with netCDF4.Dataset(path, "a") as dataset:
        owners = [dataset] if place == "global" else dataset.variables.values()
        for owner in owners:
            for key, value in vars(owner).items():
                if isinstance(value, str) and key not in UNDERSTOOD:
                    owner.setncattr(key, f"{value} {CONTROLS}".replace("\0", ""))
            owner.setncattr("comment", CONTROLS.replace("\0", ""))
    forge(path)
    code = main(["show", str(path)])
    said = capsys.readouterr()
    for line in (said.out + said.err).split("\n"):
        assert line.isprintable()
        assert not line.startswith("remake:")
    # A law or convention of such a name may be refused, in one line.
    assert code == 0 or said.err.count("\n") == 1
    if name == "summary":
        assert code == 0
        assert r"\x1b[2J" in said.out


HISTORIES = [
    ("bk simulate --law x; touch evil", "reproduce with: bk simulate --law 'x;' touch evil --out FILE"),
    ("bk simulate --a $(touch evil)", "reproduce with: bk simulate --a '$(touch' 'evil)' --out FILE"),
    ("rm -rf ~", "history: rm -rf ~"),
    ("bk check results", "history: bk check results"),
    ("bk simulate 'open", "history: bk simulate 'open"),
]


@pytest.mark.parametrize(("history", "line"), HISTORIES[:4])
def test_the_command_of_a_point_is_quoted_and_is_one_that_simulates(written, tmp_path, capsys, history, line):
    path = tmp_path / "point.nc"
    path.write_bytes((written / path.name).read_bytes())
    forge(path, history=history)
    assert main(["show", str(path)]) == 0
    assert capsys.readouterr().out.splitlines()[-1] == line


#: Names of modules outside this package, and others that lead out of it.
MODULES = [
    "evil",
    "x.evil",
    "burridge_knopoff.evil/../evil",
    "burridge_knopoff./TMP/evil",
    "burridge_knopoff",
    "",
    "a b",
]


@pytest.mark.parametrize("module", MODULES)
def test_no_module_is_imported_or_read_by_its_name_in_a_file(written, tmp_path, monkeypatch, capsys, module):
    module = module.replace("/TMP", str(tmp_path))
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(tmp_path)
    code = '"""A secret."""\nopen("ran", "w").close()\ndef digest(data):\n    return "evil"\n'
    for folder in (tmp_path, tmp_path / "x"):
        folder.mkdir(exist_ok=True)
        (folder / "evil.py").write_text(code)
    path = tmp_path / "summary.nc"
    path.write_bytes((written / path.name).read_bytes())
    forge(path, source_module=module)
    assert main(["show", str(path)]) == 0
    said = capsys.readouterr().out
    assert "secret" not in said
    assert "\nevil" not in said
    assert not (tmp_path / "ran").exists()
    assert "evil" not in sys.modules
    assert files_of(module) == []


@pytest.mark.parametrize("name", ["../../evil.py", "/etc/evil.py", "/dev/zero", "", "burridge_knopoff./dev/zero"])
def test_the_sources_of_a_file_are_no_others_than_ours(name):
    assert current_sources(f"{name} 0123456789abcdef") != f"{name} 0123456789abcdef"


@pytest.mark.parametrize("name", ["software", "source_module", "source_fingerprint"])
def test_a_file_that_does_not_say_what_made_it_is_refused_in_a_line(written, tmp_path, capsys, name):
    path = tmp_path / "summary.nc"
    path.write_bytes((written / path.name).read_bytes())
    for value in (3.5, None):
        forge(path, **{name: value})
        assert main(["show", str(path)]) == 2
        assert capsys.readouterr().err == f"bk show: {path}: does not say which software and sources made it\n"


def test_findings_are_printed_as_lines(capsys, tmp_path):
    finding = Finding("outdated", Path(f"a{CONTROLS}.yaml"), f"got {CONTROLS}")
    print_lines(*Check(tmp_path / "results/x", "1 point", [], [finding], [], []).lines())
    assert capsys.readouterr().out.count("\n") == 2


def test_the_message_of_a_bad_file_is_one_line(tmp_path):
    error = BadFile(tmp_path / f"a{CONTROLS[:-2]}".replace("\0", ""), f"got {CONTROLS}")
    assert str(error).isprintable()
    assert error.reason.isprintable()


def test_the_command_for_two_config_files_is_quoted():
    with refused("--configfile", "snakemake 'x; touch evil' --configfile 'a b.yaml'"):
        check_one_config(["a b.yaml", "x; touch evil"])


@pytest.mark.parametrize("key", ["arguments", "config_file", "software", "given"])
def test_check_prints_no_controls_of_a_record(tmp_path, capsys, key):
    """A record that is not valid is refused in a line."""
    texts = {"software": "", "git_commit": "", "arguments": "", "config_file": "x.yaml"}
    record = {**texts, "given": {}, "config": {}, "grid": {}}
    record[key] = {CONTROLS: CONTROLS} if key == "given" else CONTROLS
    (tmp_path / "study.json").write_text(json.dumps(record))
    assert main(["check", str(tmp_path)]) == 2
    said = capsys.readouterr()
    assert said.out == ""
    assert said.err.count("\n") == 1
    assert said.err.rstrip("\n").isprintable()
