"""Thousands of odd configs, runs, command lines and point files; benchmarks/fuzz.py takes as long as one likes."""

from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from burridge_knopoff.model.fields import Keys
from burridge_knopoff.study import read_config
from burridge_knopoff.study.config import CONFIG
from tests.fuzzing import configs, runs
from tests.fuzzing.points import Points


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("fuzzed")


@pytest.fixture(scope="module")
def points(tmp_path_factory):
    return Points(tmp_path_factory.mktemp("points"))


@settings(max_examples=600)
@given(st.binary(min_size=10, max_size=60))
def test_a_changed_config_is_refused_or_a_study(folder, data):
    configs.check_config(configs.mutated(data), folder)


@settings(max_examples=200)
@given(st.one_of(st.binary(max_size=200), st.text(max_size=200).map(lambda text: text.encode(errors="surrogatepass"))))
def test_any_bytes_are_no_study(folder, data):
    assert not configs.check_config(data, folder)


@pytest.mark.parametrize("text", sorted(set(configs.VALID)))
def test_the_configs_that_are_changed_are_studies(folder, text):
    assert configs.check_config(text.encode(), folder)


def test_every_key_is_among_those_that_are_changed():
    def missing(node, keys):
        for key, field in keys.fields.items():
            if key not in node:
                yield key
            elif isinstance(field.range, Keys):
                yield from missing(node[key], field.range)

    path = Path(configs.__file__).with_name("every_key.yaml")
    assert list(missing(read_config(path), CONFIG)) == []


@settings(max_examples=1000)
@given(st.binary(min_size=60, max_size=160))
def test_a_run_is_refused_or_ends_with_a_status(data):
    runs.check_run(data)


@settings(max_examples=400)
@given(st.binary(min_size=4, max_size=30))
def test_a_command_line_is_refused_or_runs(folder, data):
    runs.check_arguments(data, folder)


@settings(max_examples=500)
@given(st.binary(min_size=8, max_size=40))
def test_a_damaged_point_is_refused_or_has_its_values(points, data):
    points.check(data)


def test_an_undamaged_point_has_its_values(points):
    assert points.check_content(points.content[0])
    assert not points.check_content(points.content[1])
