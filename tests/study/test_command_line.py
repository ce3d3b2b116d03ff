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


def given_by(*entries):
    """Return the values that entries of --config give, after Snakemake has read them."""
    from snakemake.cli import parse_config

    return of_command_line(entries, parse_config(entries))


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
    assert given_by(f"key={text}") == read_config(path)


@pytest.mark.parametrize("number", ["10", "+10", "-0", "1e1", ".5", "5.", "010.5", "1E-3", " 7 "])
def test_a_number_is_that_of_a_file(tmp_path, number):
    path = tmp_path / "config.yaml"
    path.write_text(f"key: {number}\n")
    assert given_by(f"key={number}") == read_config(path) == {"key": float(number)}


@pytest.mark.parametrize("text", ["010", "-010", "7_000", "1_0.5", "1_0e5", "٣", "1٣", "٣.5", "０"])
def test_what_only_python_reads_as_a_number_is_text(tmp_path, text):
    """Also inside lists and mappings, and where the same key was given before."""
    assert given_by(f"key={text}") == {"key": text}
    assert given_by("key=3", f"key={text}") == {"key": text}
    assert given_by(f"key=[{text}, 1]", f"other={{inside: {text}}}") == {"key": [text, 1], "other": {"inside": text}}
    path = tmp_path / "config.yaml"
    path.write_text(f"key: {text}\n", encoding="utf-8")
    assert read_config(path) == {"key": text}
    with refused(f"--config: window: {text!r}"):
        load_study({**GOOD, **given_by(f"window={text}")}, "mine.yaml", GOOD)


@pytest.mark.parametrize("text", ["nan", "inf", "-Infinity", "1e400"])
def test_what_is_no_finite_number_is_refused(text):
    with refused("--config: window"):
        load_study({**GOOD, **given_by(f"window={text}")}, "mine.yaml", GOOD)


NAMES = st.sampled_from(["series", "m"])
PLAIN = st.integers(-99, 99) | st.floats(-1e6, 1e6) | st.booleans() | st.none() | NAMES
NESTED = st.recursive(PLAIN, lambda inside: st.lists(inside, max_size=3) | st.dictionaries(st.just("key"), inside))


@given(st.dictionaries(st.sampled_from(["window", "basins", "laws"]), NESTED))
@examples(200)
def test_printed_values_are_read_back(overrides):
    assert given_by(*config_entries(overrides)) == overrides


def test_an_error_names_its_place():
    with refused("--config: windows"):
        load_study({**GOOD, "windows": 3}, "mine.yaml", GOOD)
    with refused("mine.yaml: windows"):
        load_study({**GOOD, "windows": 3}, "mine.yaml", {**GOOD, "windows": 3})
    with refused("mine.yaml: windows"):
        load_study({**GOOD, "windows": 3, "v": 0.2}, "mine.yaml", {**GOOD, "windows": 3})
    # Errors that arise only from both together are attributed to the command line.
    with refused("--config: lyapunov_alignment: 90"):
        load_study({**GOOD, "transient": 50, "lyapunov_alignment": 90}, "mine.yaml", {**GOOD, "lyapunov_alignment": 90})
