"""Statements on all values of a, against a count of every case by hand and every completion of what is unknown."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest
import xarray
from hypothesis import given
from hypothesis import strategies as st

from burridge_knopoff.claims.evidence import Evidence
from burridge_knopoff.claims.statement import Statement, Truth, decided
from burridge_knopoff.claims.verdict import HOLDS, LOOSELY, NotTestableError, Share, judge_share

LAWS, STATES = ("linearized", "nonlinear"), ("minus", "plus")
LOOSE = 0.9


@st.composite
def truths(draw: st.DrawFn, values: int = 12) -> Truth:
    """Draw where a statement is true, known, and about, over (law, initial, a), without some of the dimensions."""
    shape = {"law": [*LAWS], "initial": [*STATES], "a": np.linspace(0.01, 0.1, draw(st.integers(1, values)))}
    for name in draw(st.sets(st.sampled_from(("law", "initial")))):
        del shape[name]

    def mask(share: float) -> xarray.DataArray:
        size = [len(labels) for labels in shape.values()]
        flat = draw(st.lists(st.floats(0.0, 1.0), min_size=int(np.prod(size)), max_size=int(np.prod(size))))
        return xarray.DataArray(np.reshape(np.array(flat) < share, size), coords=shape, dims=tuple(shape))

    return Truth(mask(draw(st.sampled_from((0.1, 0.5, 0.95)))), mask(0.8), mask(0.9))


@given(truths())
def test_a_share_counts_the_known_values_to_which_the_statement_applies(truth: Truth) -> None:
    cases = {case.name: case for case in truth.cases()}
    names = [LAWS if "law" in truth.is_known.dims else ("",), STATES if "initial" in truth.is_known.dims else ("",)]
    assert list(cases) == [", ".join(part for part in pair if part) for pair in product(*names)]
    for law, initial in product(*names):
        place = {key: label for key, label in (("law", law), ("initial", initial)) if label}
        right, known, applies = (part.sel(place).values for part in (truth.is_true, truth.is_known, truth.applies))
        count = [bool(r) for r, k, b in zip(right, known, applies, strict=True) if k and b]
        assert cases[", ".join(place.values())].share == Share(sum(count), len(count))


@given(truths(values=8))
def test_a_verdict_is_open_if_what_is_unknown_could_change_it(truth: Truth) -> None:
    for case in truth.cases():
        unknown = int(np.count_nonzero(~case.is_known & case.applies))
        completed = (
            {
                judge_share(Share(case.share.hits + more, case.share.count + unknown), LOOSE)
                for more in range(unknown + 1)
            }
            if case.share.count + unknown
            else set()
        )
        decides = case.share.count > 0 and (len(completed) == 1 or completed == {HOLDS, LOOSELY})
        assert case.is_decided(LOOSE) == decides
        statement = Statement(Evidence({}, {}), [case], LOOSE)
        if decides:
            assert decided(statement) is statement
        else:
            with pytest.raises(NotTestableError):
                decided(statement)


@given(truths())
def test_exceptions_name_every_value_at_which_the_statement_is_false(truth: Truth) -> None:
    for case in truth.cases():
        wrong = case.is_known & case.applies & ~case.is_true
        texts = case.exceptions("false", "unknown")
        assert any(text.startswith("false at ") for text in texts) == wrong.any()
        assert any(text.startswith("unknown at ") for text in texts) == (~case.is_known & case.applies).any()
        assert all(text.endswith(f" ({case.name})") == bool(case.name) for text in texts)
