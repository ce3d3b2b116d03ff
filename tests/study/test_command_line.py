"""Changes by --config: values as in a config file, written so that Snakemake reads them back unchanged."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from burridge_knopoff.study.command_line import config_entries, of_command_line
from burridge_knopoff.study.load import load_study
from burridge_knopoff.study.yaml_file import read_config
from tests.fuzzing import examples
from tests.refused import refused

GOOD = {"study": "x", "a": [0.1], "initial": {"minus": {}}}


def as_snakemake(entry):
    """Return the value of an entry of --config as Snakemake has read it."""
    from snakemake.cli import parse_config

    return parse_config([entry])


@pytest.mark.parametrize(
    "text",
    [
        "{pixels: 16}",
        "{pixels: 16, a: {linearized: [0.05, 1e-3]}, initial: plus}",
        "[0.1, {from: 0.2, to: 1, step: 0.1}]",
        "{m: {formula: 1 - a*u}}",
        "[yes, ~, 1:30, 010, .5, null]",
        "{pixels: }",
        "[2020-99-99]",
    ],
)
def test_nested_values_are_those_of_a_file(tmp_path, text):
    path = tmp_path / "config.yaml"
    path.write_text(f"key: {text}".replace("2020-99-99", "'2020-99-99'"))
    assert of_command_line(as_snakemake(f"key={text}")) == read_config(path)


NAMES = st.sampled_from(["series", "m"])
PLAIN = st.integers(-99, 99) | st.floats(-1e6, 1e6) | st.booleans() | st.none() | NAMES
NESTED = st.recursive(PLAIN, lambda inside: st.lists(inside, max_size=3) | st.dictionaries(st.just("key"), inside))


@given(st.dictionaries(st.sampled_from(["window", "basins", "laws"]), NESTED))
@examples(200)
def test_printed_values_are_read_back(overrides):
    read = {}
    for entry in config_entries(overrides):
        read |= as_snakemake(entry)
    assert of_command_line(read) == overrides


def test_an_error_names_its_place():
    with refused("--config: windows: unknown key"):
        load_study({**GOOD, "windows": 3}, "mine.yaml", GOOD)
    with refused("mine.yaml: windows: unknown key"):
        load_study({**GOOD, "windows": 3}, "mine.yaml", {**GOOD, "windows": 3})
    with refused("mine.yaml: windows: unknown key"):
        load_study({**GOOD, "windows": 3, "v": 0.2}, "mine.yaml", {**GOOD, "windows": 3})
    # Errors that arise only from both together are attributed to the command line.
    with refused("--config: lyapunov_alignment: 90"):
        load_study({**GOOD, "transient": 50, "lyapunov_alignment": 90}, "mine.yaml", {**GOOD, "lyapunov_alignment": 90})
