"""The search for the attractors of one model from initial states; docs/search.md says what a user can set.

`continuation` follows attractors along a, `basins` maps their basins, and `summaries.attractors` writes them to a file.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from burridge_knopoff.attractors.attractor import Attractor, perturb
from burridge_knopoff.attractors.candidates import Candidates
from burridge_knopoff.attractors.convergence import FILLING_WINDOWS
from burridge_knopoff.attractors.labels import UNDETERMINED, advance, label, label_arrays, stack_states
from burridge_knopoff.attractors.lifetime import mark_transients
from burridge_knopoff.attractors.settings import SEARCH, SearchSettings
from burridge_knopoff.messages import refusal
from burridge_knopoff.model.initial import InitialState
from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.model.sampling import sample_initial_states
from burridge_knopoff.motion.kind import CHAOS
from burridge_knopoff.motion.observables import is_on_attractor
from burridge_knopoff.motion.section_returns import Returns, state_of, visit
from burridge_knopoff.motion.set_distance import is_near
from burridge_knopoff.motion.settings import MOTION, MotionSettings
from burridge_knopoff.values import instance_of


def find_attractors(
    model: Model,
    settings: SearchSettings = SEARCH,
    motion: MotionSettings = MOTION,
    *,
    starts: Sequence[InitialState | ChainState] = (),
    start: str = "moving",
) -> tuple[list[Attractor], np.ndarray]:
    """Return the attractors of a model, and the index among them that each initial state reaches.

    settings : of the search, with the number of initial states that are drawn
    motion : how kinds of motion are distinguished
    starts : initial states in addition to the drawn ones
    start : moving or tested, see `Model.begin`

    The indices have shape (settings.samples + len(starts),), drawn states first; −1 if a state does not settle on an
    attractor. Attractors are identified by the states at the stops of the outermost block that stops regularly; those
    without stops by the states at the maxima of the velocity of the outermost block that moves. Without stops, tori of
    more than two frequencies are undetermined. Uniform sliding is among the attractors wherever it attracts.
    Another attractor that no state reaches is not found. Chaos has a `lifetime`; if this is not shown to exceed that of
    the settings, its kind is TRANSIENT_CHAOS, and the states that reach it have its index. Raises ValueError if an
    initial state does not fit the model, and if there is none.

    Times are in units of 1/ω. docs/search.md describes the search.

    >>> from burridge_knopoff import Model, SearchSettings, find_attractors
    >>> model = Model("linearized", a=0.08)
    >>> settings = SearchSettings(samples=12, transient=500, window=500)
    >>> attractors, labels = find_attractors(model, settings)
    >>> for attractor in attractors:
    ...     print(attractor.motion.kind.words, round(attractor.motion.mean_distance, 3))
    synchronized 0.0
    periodic 0.141
    >>> labels.shape, (labels == 1).sum().item()
    ((12,), 1)
    """
    instance_of(model, Model, "model")
    instance_of(settings, SearchSettings, "settings")
    instance_of(motion, MotionSettings, "motion")
    if not settings.samples and not len(starts):
        raise refusal("samples", settings.samples, "1 or more, or initial states in starts")
    search = Search(model, settings, motion)
    labels = search.labels(search.starts(starts, start))
    return mark_transients(model, search.attractors, settings), labels


# Time limit, in transients, of the first labels. Most trajectories reach an attractor within it.
QUICK_SEARCH = 0.3

# Undecided trajectories that are followed in one round before the others are compared with the new attractor.
ATTEMPTS = 3

# Largest number of rounds. Each but the first follows the discovery of an attractor.
ROUNDS = 20

# Number of states, the first of each sample, whose labels are verified.
VERIFIED_STATES = 60

# Number of states assigned to each chaotic attractor that are followed until they have converged.
VERIFIED_CHAOTIC_STATES = 6

# Perturbations, in resolutions: off an unstable motion on which a trajectory has converged, and off an unstable
# symmetry of a state that seeds the neighbouring a.
UNSTABLE_PUSH = 0.1
SYMMETRY_PUSH = 0.1


@dataclass(eq=False)
class Search(Candidates):
    """Finds the attractors of one model, and which of them each state reaches.

    1. Follow all states for a short time, then to the time limit. A state that an attractor captures is decided
       (`_discover_all`).
    2. Follow an undecided state until its motion has settled (`reach`). It may be on an attractor that is already
       listed.
    3. Otherwise measure the motion. The candidates are the motion itself and a slow set on which it lies
       (`candidates`).
    4. Add the first candidate that attracts: perturbations within a capture radius come back (`accept`). Return to
       step 1 with the new attractor. If no candidate attracts, perturb the state off the motion and repeat step 2.
    5. Follow some of the states until they are closer to their attractors. If they settle elsewhere, add that
       attractor, halve the capture radius and repeat all steps (`_verify_labels`, `_verify_chaotic_labels`).

    Calls of `find` carry out steps 1 to 5 and keep the attractors for the next call. `known_labels` labels states by
    the attractors that capture them.

    unsuccessful_states : states that were followed without finding a new attractor, as bytes
    max_unsuccessful : largest number of such states, over all rounds
    """

    unsuccessful_states: tuple[bytes, ...] = ()
    max_unsuccessful: int = 6

    def seeds(self, attractors: Iterable[Attractor]) -> list[ChainState]:
        """Return a state on each of the attractors of a neighbouring a, slightly perturbed off any symmetry.

        Between models of different v, states change in proportion to v.
        """
        generator = np.random.default_rng(self.settings.seed)
        size = SYMMETRY_PUSH * self.resolution
        states = []
        for attractor in attractors:
            state, share = attractor.motion.state(), self.model.scale / attractor.model.scale
            state = ChainState(share * state.position, share * state.velocity, state.stuck)
            states.append(perturb(state, size, generator))
        return states

    def starts(self, initial: Sequence[InitialState | ChainState], start: str) -> list[ChainState]:
        """Return the states at τ = 0 of the drawn initial states, followed by the given ones."""
        settings = self.settings
        drawn = sample_initial_states(self.model.blocks, settings.samples, *settings.box(self.model), settings.seed)
        return [
            state if isinstance(state, ChainState) else self.model.begin(state, start) for state in (*drawn, *initial)
        ]

    def labels(self, starts: Sequence[ChainState], check: bool = True) -> np.ndarray:
        """Return the index of the attractor that each state reaches, −1 for none, after `find`."""
        self.find(starts, check)
        return self.known_labels(starts)

    def find(self, starts: Sequence[ChainState], check: bool = True) -> None:
        """Add the attractors that the states reach.

        check : whether some of the labels are verified by following the trajectories for longer
        """
        self.add_sliding()
        for _ in range(ROUNDS):
            labels = self._discover_all(starts)
            if not check or (self._verify_labels(starts) and self._verify_chaotic_labels(starts, labels)):
                break

    def _discover_all(self, starts: Sequence[ChainState]) -> np.ndarray:
        """Add the attractors to which some of the states lead, and return the first one that each state comes near.

        Most states are decided early, so all of them are followed for a short time first. A state that is not decided
        continues where it is, and is compared with the new attractors only.
        """
        labels = np.full(len(starts), UNDETERMINED, dtype=np.intc)
        undecided, states = np.arange(len(starts)), stack_states(starts)
        for time in (QUICK_SEARCH * self.settings.transient, self.settings.time_limit):
            count = 0
            for _ in range(ROUNDS):
                if self.attractors[count:] and len(undecided):
                    # Whether a state stays in chaos or goes on to an orbit embedded in it, it is decided.
                    prompt = [replace(item, patience=0.0) for item in self.attractors[count:]]
                    reached, _, ends = label_arrays(self.model, prompt, *states, time)
                    left = reached == UNDETERMINED
                    labels[undecided] = np.where(left, UNDETERMINED, count + reached)
                    undecided, states = undecided[left], stack_states([state_of(end) for end in ends[left]])
                count = len(self.attractors)
                labels[undecided] = self.discover([starts[k] for k in undecided.tolist()])
                left = labels[undecided] == UNDETERMINED
                undecided, states = undecided[left], tuple(part[left] for part in states)
                if len(self.attractors) == count:
                    break
                time = QUICK_SEARCH * self.settings.transient
        return labels

    def _verify_chaotic_labels(self, starts: Sequence[ChainState], labels: np.ndarray) -> bool:
        """Follow a few states assigned to chaotic attractors, and return whether they lead to no new attractor.

        A state whose motion at the time limit is not on a known attractor is followed from there until it settles.
        """
        count = len(self.attractors)
        chaotic = [k for k, item in enumerate(self.attractors) if not item.slow and item.motion.kind in CHAOS]
        chosen = [k for index in chaotic for k in np.flatnonzero(labels == index)[:VERIFIED_CHAOTIC_STATES].tolist()]
        for state in advance(self.model, [starts[k] for k in chosen], self.settings.time_limit) if chosen else ():
            section = visit(self.model, state, 0.0, FILLING_WINDOWS * self.settings.window)
            if section is None or self._attractor_of(section) == UNDETERMINED:
                self.reach(state)
        return len(self.attractors) == count

    def _verify_labels(self, starts: Sequence[ChainState]) -> bool:
        """Label the first states and follow them until they are much closer; return whether all stay with their labels.

        If a state settles elsewhere, an unknown attractor lies within the radius. It is added, and the radius of the
        attractor to which the state was assigned is halved.
        """
        starts = starts[:VERIFIED_STATES]
        labels = self.known_labels(starts)
        narrow = [
            replace(item, radius=self.capture.recovery_distance(item.motion, item.radius)) for item in self.attractors
        ]
        closer, _ = label(self.model, narrow, starts, self.settings.time_limit)
        doubtful = np.flatnonzero((closer != labels) & (labels != UNDETERMINED)).tolist()
        verified = True
        for k in doubtful[:ATTEMPTS]:
            if self.reach(starts[k]) not in (UNDETERMINED, labels[k]):
                verified = False
                attractor = self.attractors[labels[k]]
                for index in {int(labels[k]), attractor.partner}:
                    self.attractors[index] = replace(self.attractors[index], radius=attractor.radius / 2)
        return verified

    def discover(self, starts: Sequence[ChainState]) -> np.ndarray:
        """Follow up to ATTEMPTS undecided states until one leads to a new attractor.

        Returns the index of the attractor on which each of them has settled, −1 if there is none or it is not followed.
        """
        labels, count = np.full(len(starts), UNDETERMINED, dtype=np.intc), len(self.attractors)
        states = {start.vector().tobytes(): k for k, start in enumerate(starts)}
        fresh = [state for state in states if state not in self.unsuccessful_states]
        for state in fresh[:ATTEMPTS]:
            if len(self.unsuccessful_states) >= self.max_unsuccessful:
                break
            labels[states[state]] = self.reach(starts[states[state]])
            if len(self.attractors) > count:
                break
            self.unsuccessful_states += (state,)
        return labels

    def known_labels(self, starts: Sequence[ChainState]) -> np.ndarray:
        """Return the index of the known attractor that each state reaches, −1 for none."""
        labels, _ = label(self.model, self.attractors, starts, self.settings.time_limit)
        return labels

    def reach(self, start: ChainState) -> int:
        """Follow one state until it has settled, and return the index of its attractor, which may be a new one."""
        generator = np.random.default_rng(self.settings.seed)
        for _ in range(self.trials):
            section, new = self.settle(start), len(self.attractors)
            if section is None:
                (state,) = advance(self.model, [start], self.settings.time_limit)
                return new if np.isfinite(state.position).all() and self.add_slow(state) else UNDETERMINED
            index = self._attractor_of(section)
            if index != UNDETERMINED:
                return index
            if self.add(section):
                return new
            # The trajectory has come very close to an unstable motion. It continues from a perturbation off it.
            start = perturb(section.state(), UNSTABLE_PUSH * self.resolution, generator)
        return UNDETERMINED

    def _attractor_of(self, section: Returns) -> int:
        """Return the index of the attractor on which a motion lies, −1 if it lies on none that is known."""
        for index, attractor in enumerate(self.attractors):
            if not attractor.slow and is_on_attractor(section, attractor.motion, self.resolution, self.tolerance):
                return index
        # Periodic orbits on a slow set are part of it.
        for index, attractor in enumerate(self.attractors):
            if attractor.slow and is_near(section.returns, attractor.motion.returns, self.resolution):
                return index
        return UNDETERMINED
