"""Whose results a folder holds."""

import json

import pytest

from burridge_knopoff.provenance.record import check_owner

GIVEN = {"study": "mine", "a": [0.1], "v": 0.1}


def recorded(folder, **other):
    record = {"software": "", "git_commit": "", "arguments": "", "config_file": "mine.yaml", "given": GIVEN}
    (folder / "study.json").write_text(json.dumps({**record, "config": {}, "grid": {}, **other}))


@pytest.mark.parametrize(
    ("config_file", "given"),
    [
        *(("mine.yaml", GIVEN), ("mine.yaml", {**GIVEN, "v": 0.2}), ("./sub/../mine.yaml", {**GIVEN, "v": 0.2})),
        ("moved.yaml", GIVEN),
    ],
)
def test_an_edited_or_a_moved_config_keeps_its_folder(tmp_path, monkeypatch, config_file, given):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "sub").mkdir()
    recorded(tmp_path)
    check_owner(tmp_path, config_file, given)


def test_another_config_of_the_same_name_is_refused(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    recorded(tmp_path)
    with pytest.raises(ValueError, match="study: '.*' is not allowed") as error:
        check_owner(tmp_path, "other.yaml", {"study": "mine", "a": [0.1], "window": 9})
    message = str(error.value)
    assert "\n" not in message
    assert "other.yaml: " in message
    assert "results of mine.yaml, which differs (v, window)" in message
    assert f"remove {tmp_path / 'study.json'}" in message
    (tmp_path / "study.json").unlink()
    check_owner(tmp_path, "other.yaml", {})


def test_a_damaged_record_refuses_nobody(tmp_path):
    (tmp_path / "study.json").write_text("{")
    check_owner(tmp_path, "other.yaml", GIVEN)
