"""Matches the branches of two friction laws by following attractors while one law is deformed into the other."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial

import numpy as np
from scipy.optimize import linear_sum_assignment
from scipy.spatial import cKDTree

from burridge_knopoff.attractors.settings import SearchSettings
from burridge_knopoff.continuation.matching import SAME_SET
from burridge_knopoff.laws.blend import blend
from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.motion.section_returns import Returns, visit
from burridge_knopoff.motion.set_distance import is_near
from burridge_knopoff.running.processes import parallel_map

#: Number of steps in which one friction law is deformed into another, and of values of a at which each branch is
#: followed in this way.
STEPS = 16
FOLLOWED_VALUES = 3

#: {branch: {index of a model: a state of the branch in this model, at a stop}}.
States = Mapping[int, Mapping[int, ChainState]]


def follow_law(first: Model, second: Model, start: ChainState, settings: SearchSettings) -> Returns | None:
    """Return the motion into which an attractor develops while the law of a model is deformed into that of another.

    first, second : models that differ only in the law; start : a state on an attractor of the first

    The law is changed in steps, along the straight line between both. None if the motion does not continue smoothly: it
    does not settle, or settles on a set that is not close to the one before. Raises ValueError, one line, for models
    that differ in more than the law.
    """
    first.check_same(replace(second, law=first.law), "second")
    before: Returns | None = None
    for share in np.linspace(0.0, 1.0, STEPS + 1).tolist():
        law = second.law if share == 1.0 else blend(first.law, second.law, share)
        model = replace(first, law=law)
        section = visit(model, start, settings.transient, settings.window)
        if section is None:
            return None
        if before is not None:
            pairs = ((before.returns, section.returns), (section.returns, before.returns))
            if not any(is_near(*pair, SAME_SET * model.scale) for pair in pairs):
                return None
        before, start = section, section.state()
    return before


def match_branches(
    firsts: Sequence[Model],
    seconds: Sequence[Model],
    first: States,
    second: States,
    settings: SearchSettings,
    *,
    processes: int = 1,
) -> dict[int, int]:
    """Return {branch under the second law: branch under the first} of those that develop into each other.

    firsts, seconds : the models under both laws at the same values of a
    first, second : states on the branches of each law, by branch and index of the model
    settings : how long a motion is followed
    processes : number of processes; the results do not depend on it

    Each branch of the first law is followed at a few of the values of a at which it exists, and matched with the branch
    of the second law at which it arrives most often. If several arrive at one branch, the one with the longest range is
    matched. The synchronized branch, 0, is the same under all laws.
    """
    numbers = [sorted(n for n in states if n != 0) for states in (first, second)]
    tried = []
    for row, number in enumerate(numbers[0]):
        places = sorted(first[number])
        chosen = np.linspace(0, len(places) - 1, min(FOLLOWED_VALUES, len(places))).round().astype(int)
        tried += [(row, places[i], first[number][places[i]], len(places) / len(chosen)) for i in chosen]
    models = ([law[k] for _, k, *_ in tried] for law in (firsts, seconds))
    starts = [start for *_, start, _ in tried]
    with parallel_map(processes) as pool:
        follow = partial(follow_law, settings=settings)
        followed = pool("continued to the other law", follow, *models, starts)
    arrivals = np.zeros((len(numbers[0]), len(numbers[1])))
    for (row, k, _, weight), section in zip(tried, followed, strict=True):
        near = {n: _distance(section, second[n][k]) for n in numbers[1] if k in second[n]} if section else {}
        best = min(near, key=lambda n: near[n], default=None)
        if best is not None and near[best] <= SAME_SET * firsts[k].scale:
            arrivals[row, numbers[1].index(best)] += weight
    pairs = zip(*linear_sum_assignment(arrivals, maximize=True), strict=True)
    return {0: 0} | {numbers[1][column]: numbers[0][row] for row, column in pairs if arrivals[row, column] > 0}


def _distance(section: Returns, state: ChainState) -> float:
    """Return the distance of the state at a stop from the nearest return of a motion or of its mirror image."""
    tree = cKDTree(np.concatenate([section.returns, section.mirror_returns]))
    return float(tree.query(state.vector(), p=np.inf)[0])
