"""Settings are those of the config: the same defaults, the same ranges, and one line for what lies outside."""

from dataclasses import asdict, fields

import numpy as np
import pytest

from burridge_knopoff.stability.chains import Sample, Watch
from burridge_knopoff.stability.settings import MOTION, SEARCH, BasinSettings, MotionSettings, SearchSettings
from burridge_knopoff.study import read_schema

#: {section of the config: (classes of its settings, {name: value} that any other value goes with)}
SECTIONS = {
    "motion": ((MotionSettings,), {}),
    "attractors": ((SearchSettings,), {}),
    "basins": ((BasinSettings,), {"tiles": 1}),
    "chains": ((Sample, Watch), {"symmetric_samples": 1}),
}


@pytest.fixture(scope="module")
def schema(repository):
    whole = read_schema(repository / "workflow" / "schemas" / "config.schema.yaml")["properties"]
    sections = {name: whole[name]["properties"] for name in SECTIONS}
    threshold = whole["synchronization_threshold"]
    sections["motion"] = {**sections["motion"], "synchronization_threshold": threshold}
    sections["chains"] = {**sections["chains"], "pair_distance": threshold}
    return sections


@pytest.mark.parametrize("section", SECTIONS)
def test_settings_are_those_of_the_schema(schema, section):
    classes, _ = SECTIONS[section]
    values = {key: value for kind in classes for key, value in asdict(kind()).items()}
    # What is a name, or told for the whole study, in a config.
    for key in values.keys() - {"initial", "start"}:
        assert list(np.atleast_1d(values[key])) == list(np.atleast_1d(schema[section][key]["default"])), key
    if section in ("motion", "attractors"):
        assert set(values) == set(schema[section])
    assert (MotionSettings(), SearchSettings()) == (MOTION, SEARCH)


@pytest.mark.parametrize("section", SECTIONS)
def test_ranges_are_those_of_the_schema(schema, section):
    classes, others = SECTIONS[section]
    for kind in classes:
        for key in {item.name for item in fields(kind)} & schema[section].keys():
            allowed = schema[section][key]
            rest = {name: value for name, value in others.items() if name != key and name in asdict(kind())}
            if allowed["type"] == "array":
                low, high = (allowed["items"][end] for end in ("minimum", "maximum"))
                good = [(low, high), (high - 1.0, high)]
                bad = [(low - 1.0, high), (low, high + 1.0), (high, high), (high, low), (low,), (low, 1.0, high)]
            elif allowed["type"] == "string":
                continue
            else:
                whole = allowed["type"] == "integer"
                above = "exclusiveMinimum" in allowed
                low, high = allowed["exclusiveMinimum" if above else "minimum"], allowed["maximum"]
                # A tile takes a row of pixels at least.
                high = {"tiles": 256, "symmetric_samples": 40}.get(key, high)
                low = 0 if key == "symmetric_samples" else low
                good = [high, high - 1 if whole else 0.5 * high] + ([low * 2 + high * 1e-9] if above else [low])
                bad = [low - 1, high + 1 if whole else high * 1.001, True, str(low)] + ([low] if above else [])
                bad += [low + 0.5] if whole else [float("nan")]
            for value in good:
                assert getattr(kind(**{**rest, key: value}), key) == value
            for value in bad:
                with pytest.raises(ValueError, match=f"^{key}: .* is not allowed") as caught:
                    kind(**{**rest, key: value})
                assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("kind", "values", "words"),
    [
        (SearchSettings, {"seed": 1.5}, "seed: 1.5 is not allowed: a whole number, 0 to 4294967295"),
        (SearchSettings, {"position": [0.0, "1"]}, "position: [0.0, '1'] is not allowed: [low, high] with low < high"),
        (
            SearchSettings,
            {"velocity": (-0.1, 0.2)},
            "velocity: (-0.1, 0.2) is not allowed: [low, high] with low < high",
        ),
        (SearchSettings, {"transient": 0.0}, "transient: 0.0 is not allowed: above 0, at most 1e+09"),
        (SearchSettings, {"resolution": 1.0}, "resolution: 1.0 is not allowed: 1e-06 to 0.1"),
        (BasinSettings, {"pixels": 2, "tiles": 3}, "tiles: 3 is not allowed: a whole number, 1 to 2"),
        (Sample, {"samples": 3}, "symmetric_samples: 4 is not allowed: a whole number, 0 to 3"),
        (Sample, {"start": "soon"}, "start: 'soon' is not allowed: moving | tested"),
    ],
)
def test_what_is_allowed_is_said(kind, values, words):
    with pytest.raises(ValueError, match="is not allowed") as caught:
        kind(**values)
    assert str(caught.value).startswith(words)
