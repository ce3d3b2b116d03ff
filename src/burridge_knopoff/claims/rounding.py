"""The values of a at which the start, or the last printed digit of an initial state, decides the attractor reached."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import xarray

from burridge_knopoff.claims.evidence import Evidence
from burridge_knopoff.claims.range import Range
from burridge_knopoff.claims.verdict import NotTestableError, join_words
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.study.formatting import format_count, format_values
from burridge_knopoff.study.paper import PAPER_LAWS


def rounded_state_changes(
    evidence: Evidence, initial: Sequence[str], laws: Sequence[str], a: Range
) -> dict[tuple[str, str], xarray.DataArray]:
    """Return the values of a at which some states that round to the paper's reach another attractor than the paper's.

    By (state, law), true or false over a, without those that have none. The paper gives positions to three decimals:
    see `rounded_branch` of attractors.nc.
    """
    if "attractors" not in evidence.summaries:
        return {}
    attractors = evidence.own_attractors()
    attractors = attractors.isel(a=a.choose(attractors["a"].values))
    values = {}
    for state in initial:
        for law in laws:
            own, others = (
                attractors[name].sel(law=law, initial=state).values for name in ("initial_branch", "rounded_branch")
            )
            differs = ((others != own[:, None]) & (others >= 0) & (own >= 0)[:, None]).any(axis=1)
            if differs.any():
                values[state, law] = xarray.DataArray(differs, {"a": attractors["a"]}, "a")
    return values


def other_start_changes(
    evidence: Evidence, initial: Sequence[str], laws: Sequence[str], a: Range
) -> dict[tuple[str, str], xarray.DataArray]:
    """Return the values of a at which the paper's states reach another attractor with the other start.

    The contact is that of the study. Returned as by `rounded_state_changes`.
    """
    attractors = evidence.summary("attractors").sel(contact=evidence.config["contact"])
    branch = attractors["initial_branch"].isel(a=a.choose(attractors["a"].values))
    own = branch.sel(start=evidence.config["start"], drop=True)
    differs = ((branch != own) & (branch >= 0) & (own >= 0)).any("start")
    places = {(state, law): differs.sel(law=law, initial=state, drop=True) for state in initial for law in laws}
    return {place: values for place, values in places.items() if values.any()}


def describe_rounding(evidence: Evidence) -> list[str]:
    """Describe all values of a at which the last digit of the paper's initial states decides, a text for each state."""
    try:
        evidence.check_setting()
        evidence.check_blocks()
        evidence.check_laws(PAPER_LAWS)
        for state in PAPER_STATES:
            evidence.check_state(state)
    except NotTestableError:
        return []
    values = rounded_state_changes(evidence, list(PAPER_STATES), PAPER_LAWS, Range())
    texts = []
    for state in PAPER_STATES:
        of_state = {law: differs for (name, law), differs in values.items() if name == state}
        places = [f"{format_values(at['a'].values, at.values)} ({law})" for law, at in of_state.items()]
        if places:
            texts.append(f"{state}: {'; '.join(places)}")
    return texts


def count_changes(values: Mapping[tuple[str, str], xarray.DataArray], words: str) -> list[str]:
    """Say for each state at how many of the judged values of a another attractor is reached.

    values : by (state, law), see `rounded_state_changes`; words : what reaches it, in which {state} is filled in
    """
    texts = []
    for state in dict.fromkeys(name for name, _ in values):
        counts = [(int(differs.sum()), law) for (name, law), differs in values.items() if name == state]
        first = format_count(counts[0][0], "value") + " of a"
        numbers = [f"{count if number else first} ({law})" for number, (count, law) in enumerate(counts)]
        texts.append(f"{words.format(state=state)} another attractor at {join_words(numbers)}")
    return texts
