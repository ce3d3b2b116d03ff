"""docs/api.md: each call of its table runs, each key is one of a config, and each command is one of `bk`."""

import re
import shlex
from pathlib import Path

import pytest
import yaml

import burridge_knopoff
from burridge_knopoff.cli import build_parser
from burridge_knopoff.study.load import load_study

TEXT = (Path(__file__).parents[1] / "docs/api.md").read_text(encoding="utf-8")
ROWS = [re.split(r"\s*\|\s*", line)[1:-1] for line in re.findall(r"^\| .*`.*\|$", TEXT, re.M)]
PYTHON, CONFIGS, COMMANDS = ([row[n].strip("`") for row in ROWS if row[n]] for n in (1, 2, 3))
#: Shorter than by default.
QUICK = {
    "find_attractors(": {"samples": 12, "transient": 500, "window": 500},
    "basin_map(": {"samples": 12, "transient": 500, "window": 500, "pixels": 4},
    "continue_attractors(": {"samples": 12, "transient": 1000, "window": 800, "fraction_width": 0.2, "refine": 0.01},
    "edge_state(": {"settings": burridge_knopoff.EdgeSettings(duration=3000, samples=20)},
}
SLOW = ("edge_state(", "continue_attractors(", "label_states(")


def test_the_table_has_a_question_a_line():
    assert len(ROWS) == len({row[0] for row in ROWS}) >= 20
    assert all(len(row) == 4 for row in ROWS)
    named = {*re.findall(r"(\w+)\(", " ".join(PYTHON))} | {"Run", "Model"}
    assert (
        {"simulate", "sweep", "plot", "follow", "PhysicalUnits"}
        <= named
        <= {*burridge_knopoff.__all__, *dir(burridge_knopoff.Run), "points", "v", "at", "Run", "Model"}
    )


@pytest.fixture(scope="module")
def names():
    """What the calls of the table may use: two runs, and the attractors of their model."""
    public = {name: getattr(burridge_knopoff, name) for name in burridge_knopoff.__all__}
    run, other = (public["simulate"](public["Model"]("linearized", a=0.08), initial) for initial in ("plus", "minus"))
    attractors, _ = public["find_attractors"](run.model, starts=[run, other], **QUICK["find_attractors("])
    return {**public, "model": run.model, "run": run, "other": other, "attractors": attractors}


@pytest.mark.parametrize(
    "call",
    [pytest.param(call, marks=pytest.mark.slow) if call.startswith(SLOW) else call for call in PYTHON],
)
def test_a_call_of_python_runs(call, names):
    if call.startswith("open_study("):
        assert callable(names["open_study"])
        return
    options = "".join(
        f", {key}={value!r}" for start, quick in QUICK.items() if call.startswith(start) for key, value in quick.items()
    )
    assert eval(f"{call[:-1]}{options})" if options else call, dict(names)) is not None


@pytest.mark.parametrize("lines", CONFIGS)
def test_keys_of_a_config_are_accepted(lines, tmp_path):
    keys = yaml.safe_load(lines)
    base = {"study": "own", "initial": {"minus": {}, "plus": {}}} | ({} if "grid" in keys else {"a": [0.05, 0.08]})
    assert load_study({**base, **keys}, str(tmp_path / "study.yaml"))


@pytest.mark.parametrize("line", COMMANDS)
def test_a_command_is_accepted(line):
    program, *words = shlex.split(line)
    assert program == "bk"
    law = [] if "--law" in words or "--formula" in words else ["--law", "linearized"]
    common = [] if words[0] in ("show", "check") else [*law, "--a", "0.08"]
    assert vars(build_parser().parse_args([*words, *common]))
