"""Settings: every field takes the ends of its range and refuses, in one line, what lies outside.

config/README.md has the ranges and defaults themselves; tests/study/test_keys.py compares it with the fields.
"""

import numpy as np
import pytest

from burridge_knopoff import MotionSettings, SearchSettings
from burridge_knopoff.attractors.settings import SEARCH
from burridge_knopoff.basins.settings import BasinSettings
from burridge_knopoff.model.fields import fields_of
from burridge_knopoff.model.ranges import Interval, Number, Whole
from burridge_knopoff.motion.chain_settings import Sample, Watch
from burridge_knopoff.motion.settings import MOTION
from burridge_knopoff.running.section import Section, SectionRange
from tests.refused import refused

#: {class: values that are compatible with any value of another field}
CLASSES = {
    MotionSettings: {},
    SearchSettings: {},
    BasinSettings: {"tiles": 1},
    Sample: {"symmetric_samples": 1},
    Watch: {},
}
FIELDS = [(kind, name) for kind in CLASSES for name in fields_of(kind)]


def values(kind, name):
    """Return values that a field accepts, and values that it refuses."""
    allowed = fields_of(kind)[name].range
    if isinstance(allowed, Interval):
        low, high = allowed.ends.least, allowed.ends.most
        bad = [(low - 1.0, high), (low, high + 1.0), (high, high), (high, low), (low,), (low, 1.0, high), ("0", "1")]
        return [(low, high), (high - 1.0, high)], [*bad, 1.0]
    if isinstance(allowed, Whole):
        # A tile has at least one row of pixels, and the symmetric samples are among all samples.
        most = {"tiles": BasinSettings().pixels, "symmetric_samples": Sample().samples}.get(name, allowed.most)
        return [allowed.least, most], [allowed.least - 1, allowed.most + 1, allowed.least + 0.5, True, "3"]
    if isinstance(allowed, SectionRange):
        return [Section(), Section("block", 2)], [1, None, ["sum"]]
    assert isinstance(allowed, Number)
    least, most = allowed.least, allowed.most
    good = [np.nextafter(least, np.inf), most] + ([] if allowed.above else [least])
    bad = [np.nextafter(least, -np.inf), np.nextafter(most, np.inf), np.nan, np.inf, True, "3", None]
    return good, bad + ([least] if allowed.above else [])


@pytest.mark.parametrize(("kind", "name"), [(kind, name) for kind, name in FIELDS if name not in ("initial", "start")])
def test_a_setting_accepts_its_range_and_nothing_else(kind, name):
    others = {key: value for key, value in CLASSES[kind].items() if key != name}
    good, bad = values(kind, name)
    for value in good:
        taken = getattr(kind(**{**others, name: value}), name)
        assert np.array_equal(taken, value)
    for value in bad:
        with refused(match=rf"^{name}: got .*, expected"):
            kind(**{**others, name: value})


def test_a_map_has_a_row_for_each_tile():
    with pytest.raises(ValueError, match="tiles: got 3, expected"):
        BasinSettings(pixels=2, tiles=3)


def test_functions_have_the_defaults_of_the_classes():
    assert (MotionSettings(), SearchSettings()) == (MOTION, SEARCH)
