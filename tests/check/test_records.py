"""The record of a study: it is refused in a line unless this version, or an earlier one, has written it."""

import json
from functools import reduce
from operator import getitem

import netCDF4
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from burridge_knopoff import open_study
from burridge_knopoff.cli import main
from burridge_knopoff.study.recorded import recorded_study
from tests.check.conftest import change_record
from tests.forged import forge
from tests.refused import refused, refuses


def is_part(one, other):
    """Return whether a config lacks keys of another, and is equal otherwise."""
    if isinstance(one, dict) and isinstance(other, dict):
        return all(key in other and is_part(value, other[key]) for key, value in one.items())
    return one == other


def parts(value, *path):
    """Yield the path of every part of a record."""
    yield path
    inside = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, item in inside:
        yield from parts(item, *path, key)


@given(data=st.data())
@settings(max_examples=60, suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
def test_a_record_that_was_changed_by_hand_is_refused_in_a_line_that_names_it(results, data):
    """Whatever part of it was replaced by whatever there is."""
    record = results / "study.json"
    text = record.read_text()
    content = json.loads(text)
    _, *paths = parts({key: content[key] for key in ("config", "grid")})
    *place, name = data.draw(st.sampled_from(paths))
    nested = reduce(lambda inside, _: [inside], range(50), [])
    reduce(getitem, place, content)[name] = data.draw(
        st.sampled_from([None, [], {}, "x\ny", -1, 1e300, nested, True, [[]]])
    )
    try:
        record.write_text(json.dumps(content))
        if content != json.loads(text):
            try:
                _, study = recorded_study(results)
            except ValueError as error:
                line = str(error)
                assert "study.json: " in line and line.isprintable() and len(line) < 1000  # noqa: PT018
            else:
                # Keys were lost, as an earlier version may lack them.
                assert is_part(content["config"], study.config)
    finally:
        record.write_text(text)


WRONG = b'{"software": "", "git_commit": "", "arguments": "", "config_file": "", "given": {}, "config": 6, "grid": {}}'


@pytest.mark.parametrize("content", [None, b"", b"{", b"\xff", b"[]", b"{}", WRONG, b"[" * 100_000])
def test_a_folder_that_is_no_study_is_refused_in_a_line(tmp_path, capsys, content):
    if content is not None:
        (tmp_path / "study.json").write_bytes(content)
    assert main(["check", str(tmp_path)]) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert said.startswith(f"bk check: {tmp_path}")


@pytest.mark.parametrize(
    ("place", "change", "words"),
    [
        ("", {"colour": "red"}, "colour: "),
        ("motion", {"colour": 1}, "motion.colour: "),
        ("attractors", {"pushes": 8}, "attractors.pushes: "),
        ("", {"basins": 3}, "basins: "),
    ],
)
def test_a_study_with_a_key_that_this_version_lacks_is_refused_in_a_line(results, capsys, place, change, words):
    change_record(results, lambda record: reduce(getitem, place.split(), record["config"]).update(change))
    path = str(results / "study.json")
    assert main(["check", str(results)]) == 2
    assert refuses(capsys.readouterr().err, path, words, "snakemake")
    with refused(path, words):
        open_study(results)


@pytest.mark.parametrize("key", ["contact", "attractors.lifetime", "motion.longest_period", "edges"])
def test_a_study_of_a_version_without_a_key_is_opened(results, key):
    """Its files do not have the key either."""
    *sections, name = key.split(".")
    change_record(results, lambda record: reduce(getitem, sections, record["config"]).pop(name, None))
    path = results / "summary/mean_distance.nc"
    for other in [*results.rglob("*.*")]:
        if other.is_file() and other.parts[2] not in ("points", "solvers", "study.json") and other != path:
            other.unlink()
    with netCDF4.Dataset(path) as dataset:
        params = json.loads(dataset.params)
    params.pop(key, None)
    forge(path, params=json.dumps(params))
    assert main(["check", str(results)]) == 0
    study = open_study(results)
    assert study["summary/mean_distance"].sizes
    assert study.config["contact"] == "one_sided"
