"""Help: an example of every command, each of which runs as it stands; completion of a shell."""

import re
import shlex
import shutil
import subprocess
from glob import glob
from itertools import pairwise

import pytest

from burridge_knopoff.cli import COMMANDS, build_parser, main
from tests.small_study import run_study


def examples(command):
    """Return the examples in the help text of a command, as arguments of `bk`."""
    (commands,) = [action for action in build_parser(command)._actions if action.dest == "command"]
    epilog = commands.choices[command].epilog
    return [shlex.split(line)[1:] for line in re.findall(r"^  (bk .*)$", epilog, re.MULTILINE)]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder with the results of a study named as the default one."""
    folder = tmp_path_factory.mktemp("examples")
    results = folder / "results" / "paper"
    config = {"study": "paper", "a": [0.08], "initial": {"plus": {}}, "laws": {"linearized": {}}}
    config |= {"transient": 10, "window": 20, "batches": 2}
    run_study(results, config).record(folder / "paper.yaml", config)
    # As in the repository.
    (folder / "results/README.md").touch()
    return folder


@pytest.mark.slow
@pytest.mark.parametrize("command", [name for name in COMMANDS if name != "completion"])
def test_the_examples_of_a_command_run(folder, command, monkeypatch, capsys):
    """In the order of the commands: what is shown has been made by those before."""
    monkeypatch.chdir(folder)
    if command == "show":
        for example in (examples("simulate")[0], examples("basins")[0]):
            if not (folder / example[-1]).exists():
                main(example)
    for example in examples(command):
        capsys.readouterr()
        if "results/*/" in example:
            example = [*example[:-1], *glob("results/*/")]
        assert main(example) == 0, example
        said = capsys.readouterr()
        assert said.err == ""
        assert said.out or "--paths" in example
        for word, file in pairwise(example):
            if word in ("--out", "--attractors-out", "--plot"):
                assert (folder / file).stat().st_size > 1000


def test_help_fits_the_terminal(monkeypatch, capsys):
    """Except the examples, which can be copied as one line."""
    monkeypatch.setenv("COLUMNS", "80")
    for command in COMMANDS:
        with pytest.raises(SystemExit):
            main([command, "--help"])
        lines = capsys.readouterr().out.splitlines()
        assert not [line for line in lines if len(line) > 80 and not line.startswith("  bk ")]


def test_help_says_every_percent_sign(capsys):
    for command in COMMANDS:
        with pytest.raises(SystemExit, match="0"):
            main([command, "--help"])
        assert "examples:" in capsys.readouterr().out


@pytest.mark.parametrize("command", ["simulate", "exponents", "orbit", "attractors", "basins", "catalogue"])
def test_what_is_said_of_a_setting_is_true_without_a_study(command, capsys):
    with pytest.raises(SystemExit, match="0"):
        main([command, "--help"])
    said = " ".join(capsys.readouterr().out.split())
    for of_blocks in ("--grid", "ring or grid", "in a grid:"):
        said = said.replace(of_blocks, "")
    assert not re.findall(r"\b(study|stages?|jobs?|config|grid)\b", said)


#: What bash does when the tab key is pressed, and what it is to answer.
ASK = 'ask() { COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); COMPREPLY=(); _shtab_bk; echo "${COMPREPLY[@]}"; }'
ANSWERS = {
    "bk sim": "simulate",
    "bk simulate --law lin": "linearized",
    "bk simulate --contact ''": "one_sided symmetric",
    "bk basins --pix": "--pixels",
    "bk completion ''": "bash zsh fish",
}


@pytest.mark.skipif(shutil.which("bash") is None, reason="bash is not installed")
def test_a_shell_completes_commands_options_and_words(capsys):
    pytest.importorskip("shtab")
    for shell in ("zsh", "fish", "bash"):
        assert main(["completion", shell]) == 0
        script = capsys.readouterr().out
        assert "--attractors-out" in script
    asked = "\n".join([script, ASK, *(f"ask {line}" for line in ANSWERS)])
    answered = subprocess.run(["bash"], input=asked, capture_output=True, text=True, check=True)
    assert answered.stdout.splitlines() == list(ANSWERS.values())
