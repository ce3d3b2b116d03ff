"""Verdicts: counted, by topic, and refused in one line where the file is wrong."""

import json

import pytest

from burridge_knopoff.claims.formats import as_json
from burridge_knopoff.report.verdicts import SIGNS, read_verdicts
from tests.refused import refused
from tests.report.conftest import CLAIMS


@pytest.fixture
def read(tmp_path):
    """Read the verdicts of a file with other content."""

    def changed(change):
        content = json.loads(CLAIMS.read_text())
        change(content)
        (tmp_path / "claims.json").write_text(as_json(content))
        return read_verdicts(tmp_path / "claims.json")

    return changed


def test_verdicts_are_counted_and_put_by_topic():
    verdicts = read_verdicts(CLAIMS)
    assert list(verdicts.counts) == list(SIGNS)
    assert set(verdicts.counts.values()) == {1}
    assert verdicts.independent == {**verdicts.counts, "fails": 0}
    assert [(topic, len(claims)) for topic, claims in verdicts.topics.items()] == [
        ("Synchronization of the end blocks", 2),
        ("Friction laws", 1),
        ("Motion of the blocks", 3),
    ]
    assert list(verdicts.untestable) == ["The study has no experiment."]
    assert verdicts.setting["contact"] == "one_sided"


def test_what_cannot_be_judged_is_put_by_its_reason(read):
    def judge_nothing(content):
        content["counts"] = dict.fromkeys(SIGNS, 0) | {"not testable": len(content["claims"])}
        for number, claim in enumerate(content["claims"]):
            claim.update(verdict="not testable", reason="Few values." if number else "Short runs.", conventions={})

    verdicts = read(judge_nothing)
    counts = {reason: len(claims) for reason, claims in verdicts.untestable.items()}
    assert counts == {"Short runs.": 1, "Few values.": 6}
    assert verdicts.topics == {}
    assert sum(read_verdicts(None).counts.values()) == 0


@pytest.mark.parametrize("text", ["", "[]", "{}", "null", '{"claims": '])
def test_what_is_no_file_of_verdicts_is_one_line(tmp_path, text):
    path = tmp_path / "claims.json"
    path.write_text(text)
    with refused("claims.json"):
        read_verdicts(path)
