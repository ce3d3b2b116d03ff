"""What has changed since the files of a study were made."""

import json

import pytest
from matplotlib.figure import Figure
from netCDF4 import Dataset

from burridge_knopoff.check.changes import changes
from burridge_knopoff.provenance.origin import NAME, Origin, with_origin
from burridge_knopoff.study.load import load_study

STUDY = load_study({"study": "some", "a": [0.1], "initial": {"minus": {}}, "window": 70}, "some.yaml")
BEFORE, NOW = "figure.py 1111", "figure.py 2222"


def write(path, origin):
    """Write an empty result with its origin."""
    match path.suffix:
        case ".png":
            Figure((0.1, 0.1)).savefig(path, metadata={NAME: json.dumps(vars(origin))})
        case ".nc":
            with Dataset(path, "w") as dataset:
                dataset.setncatts(origin.attributes())
        case ".json":
            path.write_text(with_origin("{}", path.name, origin))
        case ".html":
            path.write_text(with_origin("<head></head>", path.name, origin))


@pytest.mark.parametrize("name", ["lyapunov.png", "lyapunov.nc", "claims.json", "report.html"])
def test_sources_and_keys(tmp_path, name):
    """Of pictures and texts as well as of netCDF files."""
    write(tmp_path / name, Origin(name, "some_rule", {"window": 60.0, "transient": 3000.0}, {}, BEFORE))
    same = {"window: 60.0 → 70.0": ["some_rule"]}
    assert changes(STUDY, tmp_path, {name: BEFORE}) == same
    assert changes(STUDY, tmp_path, {name: NOW}) == {**same, "the sources": ["some_rule"]}


@pytest.mark.parametrize("name", ["lyapunov.png", "lyapunov.nc", "claims.json", "report.html", "lyapunov.pdf"])
@pytest.mark.parametrize("content", [None, b"", b"[]", b'{"origin": 3}', b"\x89PNG\r\n\x1a\n", b"\xff\xfe"])
def test_a_file_without_an_origin_is_new(tmp_path, name, content):
    if content is not None:
        (tmp_path / name).write_bytes(content)
    assert changes(STUDY, tmp_path, {name: NOW}) == {}
