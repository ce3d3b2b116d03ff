"""Attractors matched along a: what each one turns into when a is stepped up or down, and the branches that this makes.

Reference: G. Datseris, K. Luiz Rossi and A. Wagemakers, "Framework for global stability analysis of dynamical systems",
Chaos 33 (2023) 073151: the search at each parameter begins from the attractors at the one before.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import linear_sum_assignment

from burridge_knopoff.model.initial import InitialState
from burridge_knopoff.model.model import Instant, Model
from burridge_knopoff.stability.attractor import Attractor, Symmetry, pushed
from burridge_knopoff.stability.attractors import Search
from burridge_knopoff.stability.labels import UNDETERMINED
from burridge_knopoff.stability.settings import MOTION, SEARCH, MotionSettings, SearchSettings
from burridge_knopoff.stability.tuning import TUNING, Tuning

#: ⟨J⟩ and which blocks stick, on a branch at one a; and {branch: {position of a in the grid: that}}.
BranchPoint = tuple[float, tuple[bool, ...]]
BranchCurves = Mapping[int, dict[int, BranchPoint]]


@dataclass(frozen=True, eq=False)
class Continuation:
    """The attractors of one law along a.

    attractors : for each a those that coexist there
    upward, downward : for each a and attractor the index of the attractor reached at the next larger or smaller a, −1
        where it is undetermined or there is no next a
    branch, side : for each a and attractor the number of its branch and its side of it; see `branches`
    samples : for each a the index reached by each drawn state, and after them by those that were given
    """

    attractors: list[list[Attractor]]
    upward: list[np.ndarray]
    downward: list[np.ndarray]
    branch: list[np.ndarray]
    side: list[np.ndarray]
    samples: list[np.ndarray]


def continue_attractors(
    models: Sequence[Model],
    settings: SearchSettings = SEARCH,
    motion: MotionSettings = MOTION,
    *,
    starts: Sequence[InitialState] = (),
    start: str = "moving",
    tuning: Tuning = TUNING,
) -> Continuation:
    """Find the attractors of all models, of ascending a, from initial states and from each other, and match them.

    settings, motion, starts, start, tuning : see `find_attractors`

    Raises ValueError if an initial state does not fit the models.
    """
    generator = np.random.default_rng(settings.seed)
    searches = [Search(model, settings, motion, tuning) for model in models]
    begun = [search.starts(starts, start) for search in searches]

    def seeds(search: Search) -> list[Instant]:
        size = tuning.symmetry_push * search.resolution
        return [pushed(attractor.motion.instant(), size, generator) for attractor in search.attractors]

    labels = []
    for k, search in enumerate(searches):
        before = seeds(searches[k - 1]) if k else []
        labels.append((search.labels([*before, *begun[k]])[len(before) :], list(search.attractors)))
    for k in range(len(searches) - 2, -1, -1):
        searches[k].labels(seeds(searches[k + 1]), check=False)
    for k in range(1, len(searches)):
        searches[k].labels(seeds(searches[k - 1]), check=False)
    # The sets of attractors are complete now: what follows only reads them.
    upward, downward = [], []
    for k, search in enumerate(searches):
        nothing = np.full(len(search.attractors), UNDETERMINED)
        upward.append(searches[k + 1].known_labels(seeds(search)) if k + 1 < len(searches) else nothing)
        downward.append(searches[k - 1].known_labels(seeds(search)) if k else nothing)
    attractors = [search.attractors for search in searches]
    return Continuation(
        attractors,
        upward,
        downward,
        *branches(attractors, upward, downward),
        [
            found if search.attractors == then else search.known_labels(states)
            for search, states, (found, then) in zip(searches, begun, labels, strict=True)
        ],
    )


def branches(
    attractors: Sequence[Sequence[Attractor]], upward: Sequence[np.ndarray], downward: Sequence[np.ndarray]
) -> tuple[list[np.ndarray], list[np.ndarray]]:
    """Return the branch and the side of each attractor at each a.

    Attractors of neighbouring a are on one branch if each, or its mirror image, is reached from the other. The two of a
    mirror pair share a branch and lie on its sides 1 and −1; attractors that are their own mirror images have side 0.
    Branch 0 is the synchronized attractor, wherever it exists, and nothing else: what it turns into where it loses its
    stability is another branch. Other branches are numbered from 1 in the order of their first a, and of ⟨J⟩ there.
    """
    branch_of: list[np.ndarray] = []
    side_of: list[np.ndarray] = []
    following = 1
    for k, here in enumerate(attractors):
        branch = np.full(len(here), UNDETERMINED)
        side = np.zeros(len(here), dtype=int)
        # Of a mirror pair one is matched, and the other goes with it.
        single = [i for i, attractor in enumerate(here) if attractor.partner >= i]
        for i in sorted(single, key=lambda i: (round(here[i].motion.mean_distance, 6), i)):
            before = UNDETERMINED
            if k and here[i].symmetry != Symmetry.SYNCHRONIZED:
                before = int(downward[k][i])
            if before != UNDETERMINED:
                back = int(upward[k - 1][before])
                same_kind = attractors[k - 1][before].symmetry != Symmetry.SYNCHRONIZED
                if not same_kind or back not in (i, here[i].partner) or branch_of[k - 1][before] in branch:
                    before = UNDETERMINED
            if here[i].symmetry == Symmetry.SYNCHRONIZED:
                branch[i] = 0
            elif before != UNDETERMINED:
                branch[i] = branch_of[k - 1][before]
            else:
                branch[i] = following
                following += 1
            if here[i].partner != i:
                side[i] = side_of[k - 1][before] if before != UNDETERMINED else 0
                side[i] = side[i] or _orientation(here[i])
                branch[here[i].partner], side[here[i].partner] = branch[i], -side[i]
        branch_of.append(branch)
        side_of.append(side)
    return branch_of, side_of


def _orientation(attractor: Attractor) -> int:
    """Return 1 where the first block, at its stops, is ahead of the last one by more than in the mirrored motion."""
    last = len(attractor.motion.stop_rate) - 1
    own, mirrored = attractor.motion.returns, attractor.motion.mirror_returns
    return 1 if np.mean(own[:, 0] - own[:, last]) > np.mean(mirrored[:, 0] - mirrored[:, last]) else -1


def same_numbers(first: BranchCurves, second: BranchCurves, tolerance: float, largest: int) -> dict[int, int]:
    """Return new numbers for the branches of a second law: a branch that both laws have keeps one number.

    Branches are paired so that as many values of a as possible lie on both of a pair, with ⟨J⟩ equal within the
    tolerance and the same blocks sticking. The synchronized branch is 0 in both; what has no partner is numbered on
    from the largest number that is taken.
    """
    numbers = [sorted(n for n in curves if n > 0) for curves in (first, second)]
    common = np.array([[_overlap(first[m], second[n], tolerance) for n in numbers[1]] for m in numbers[0]])
    renamed = {0: 0}
    if common.size:
        for row, column in zip(*linear_sum_assignment(common, maximize=True), strict=True):
            if common[row, column] > 0:
                renamed[numbers[1][column]] = numbers[0][row]
    following = largest + 1
    for number in numbers[1]:
        if number not in renamed:
            renamed[number] = following
            following += 1
    return renamed


def _overlap(first: dict[int, BranchPoint], second: dict[int, BranchPoint], tolerance: float) -> int:
    """Return at how many a two branches look alike."""
    shared = [(first[k], second[k]) for k in first.keys() & second.keys()]
    return sum(abs(one[0] - other[0]) <= tolerance and one[1] == other[1] for one, other in shared)
