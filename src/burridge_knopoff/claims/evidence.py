"""The summaries and the setting of a study, in the form that the judges of claims use."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from burridge_knopoff.claims.range import Range
from burridge_knopoff.claims.verdict import NotTestableError, Verdict, join_words
from burridge_knopoff.laws import law_of
from burridge_knopoff.model.chain import Chain
from burridge_knopoff.model.initial import PAPER_V, has_paper_numbers, initial_state
from burridge_knopoff.running.status import Status
from burridge_knopoff.study.paper import PAPER_LAWS, PAPER_TRANSIENT, PAPER_WINDOW

if TYPE_CHECKING:
    import xarray

_T = TypeVar("_T")

# A statement on a range of a is judged only with at least this many values of a, which have to cover the range.
MIN_VALUES = 10

#: {dimension of a summary with its own values of a: key of the config that has them}
_KEYS = {"phase_difference": "phases.a", "chain": "chains.two_blocks.a", "blocks": "chains.a", "solver": "solvers.a"}

# Accuracy of a computed a_c: rounding of the multiplier divided by its slope.
CRITICAL_A_ROUNDING = 1e-13


@dataclass(frozen=True)
class Evidence:
    """The results of a study.

    summaries : Datasets by name, of those that claims depend on; without those that the study does not make
    config : the study's config: laws, chain, v, contact, start, transient, window, initial, and the section `motion`
    verdicts : on the claims judged before, by name
    selected : selections from summaries, each with its source, so that the id of the source stays valid: the judges
        repeat the same selections hundreds of times
    """

    summaries: Mapping[str, xarray.Dataset]
    config: Mapping[str, Any]
    verdicts: Mapping[str, Verdict] = field(default_factory=dict)
    selected: dict[Hashable, tuple[Any, object]] = field(default_factory=dict, repr=False, compare=False)

    def cached(self, key: Hashable, select: Callable[[], _T], source: object = None) -> _T:
        """Return the selection from a Dataset, `source`, computed at the first request."""
        place = id(source), key
        if place not in self.selected:
            self.selected[place] = select(), source
        return self.selected[place][0]

    @cached_property
    def halves(self) -> list[Evidence]:
        """The evidence at every second value of a, starting with the first and with the second."""
        return [
            replace(
                self,
                summaries={
                    name: dataset.isel(a=slice(first, None, 2)) if "a" in dataset.dims else dataset
                    for name, dataset in self.summaries.items()
                },
            )
            for first in (0, 1)
        ]

    def check_variants(self) -> None:
        """Raise NotTestableError if nothing tells what other starts and states that round to the paper's lead to."""
        if "attractors" not in [*self.summaries]:
            raise NotTestableError(
                "the study has no summary attractors.nc, by which another start, or states that round to the paper's, "
                "could change the verdict"
            )

    def check_setting(self) -> None:
        """Raise NotTestableError if the driver velocity, springs, masses or friction are not the paper's."""
        if self.config["v"] != PAPER_V:
            raise NotTestableError(f"the paper's driver has v = {PAPER_V}, that of the study v = {self.config['v']:g}")
        if not Chain(**self.config["chain"]).is_equivalent_to(Chain(self._blocks)):
            raise NotTestableError("the study's chain has other springs, masses or friction than the paper's")

    def check_laws(self, laws: Iterable[str]) -> None:
        """Raise NotTestableError if the study lacks one of these laws of the paper, or uses its name for another."""
        for law in laws:
            if law not in self.config["laws"]:
                raise NotTestableError(f"the study has no {law} law")
            description = self.config["laws"][law]
            if self.cached((law, str(description)), partial(law_of, {law: description})) != law_of(law):
                raise NotTestableError(f"the study's {law} law is not the paper's")

    def check_runs(self) -> None:
        """Raise NotTestableError if the runs are shorter than the paper's, and might not have settled."""
        transient, window = self.config["transient"], self.config["window"]
        if transient < PAPER_TRANSIENT or window < PAPER_WINDOW:
            raise NotTestableError(
                f"the paper's runs have a transient of {PAPER_TRANSIENT:g} and a window of {PAPER_WINDOW:g}, those of "
                f"the study {transient:g} and {window:g}"
            )

    def check_blocks(self) -> None:
        """Raise NotTestableError if the chain is not the paper's."""
        if self._blocks != 3:
            raise NotTestableError(f"the paper's chain has 3 blocks, that of the study {self._blocks}")

    @property
    def _blocks(self) -> int:
        return Chain(**self.config["chain"]).blocks

    def summary(self, name: str) -> xarray.Dataset:
        """Return a summary, for the paper's laws only; raises NotTestableError if the study does not have it."""
        if name not in self.summaries:
            raise NotTestableError(f"the study has no summary {name}.nc")
        dataset = self.summaries[name]
        if "law" not in dataset.dims or set(dataset["law"].values) <= {*PAPER_LAWS}:
            return dataset
        laws = [law for law in dataset["law"].values if law in PAPER_LAWS]
        return self.cached("laws", lambda: dataset.sel(law=laws), dataset)

    def law_comparison(self, dataset: xarray.Dataset) -> xarray.Dataset:
        """Return the comparison of the paper's two laws from a summary that compares laws with the first one.

        Raises NotTestableError if the first law of the study is neither of the two.
        """
        first = next(iter(self.config["laws"]))
        if first not in PAPER_LAWS:
            raise NotTestableError(f"the laws of the study are compared with its first one, the {first} law")
        (other,) = (law for law in PAPER_LAWS if law != first)
        return dataset.sel(other_law=other)

    def state_summary(self, name: str, initial: str | Sequence[str]) -> xarray.Dataset:
        """Return a summary for one of the paper's initial states, or over several, completed runs only.

        Raises NotTestableError if the study lacks a state, or uses its name for another.
        """
        self.check_runs()
        for state in [initial] if isinstance(initial, str) else initial:
            self.check_state(state)
        dataset = self.summary(name)

        def select() -> xarray.Dataset:
            runs = dataset.sel(initial=initial if isinstance(initial, str) else list(initial))
            return runs.where(runs["status"] == Status.COMPLETED) if "status" in runs else runs

        return self.cached(("initial", initial if isinstance(initial, str) else tuple(initial)), select, dataset)

    def check_state(self, initial: str) -> None:
        """Raise NotTestableError if the study has no initial state of that name, or it is not the paper's."""
        states = self.config["initial"]
        if initial not in states:
            raise NotTestableError(f"the study has no initial state {initial}")
        if not has_paper_numbers(initial_state(initial, **states[initial])):
            raise NotTestableError(f"the study's initial state {initial} is not the paper's")

    def choose(self, dataset: xarray.Dataset, a: Range) -> xarray.Dataset:
        """Return the part of a summary in a range of a; raises NotTestableError unless its values cover the range."""
        values = dataset["a"].values
        check_covered(values, a, next((key for name, key in _KEYS.items() if name in dataset.dims), "the study"))
        chosen = a.choose(values)
        return self.cached(("a", chosen.tobytes()), lambda: dataset.isel(a=chosen), dataset)

    def at(self, dataset: xarray.Dataset, a: float) -> xarray.Dataset:
        """Return a summary at one value of a; raises NotTestableError if it is not in the grid."""
        if a not in dataset["a"].values:
            raise NotTestableError(f"a = {a:g} is not in the grid")
        return self.cached(("a", a), lambda: dataset.sel(a=a), dataset)

    def negative_damping(self, law: str, a: np.ndarray) -> np.ndarray:
        """Return −F'(v), the rate at which friction falls with velocity at the driver velocity, at values of a."""
        v = self.config["v"]
        key = law, v, a.tobytes()
        return self.cached(key, lambda: np.array([-float(law_of(law, a=value).slope(v)) for value in a]))

    @property
    def own_convention(self) -> str:
        """The study's convention of contact and start, as tables name it."""
        return f"{self.config['contact']}, {self.config['start']}"

    def other_conventions(self) -> Iterator[tuple[str, xarray.Dataset]]:
        """Yield («contact, start», the attractors with the branches of the initial states) for each convention.

        The study's own is left out. Raises NotTestableError if the study has no attractors.
        """
        self.check_blocks()
        attractors = self.summary("attractors")
        for contact in attractors["contact"].values:
            for start in attractors["start"].values:
                if (name := f"{contact}, {start}") != self.own_convention:
                    yield name, self._convention_attractors(contact, start)

    def own_attractors(self) -> xarray.Dataset:
        """Return the attractors with the branches that initial states reach under the study's convention."""
        self.check_blocks()
        return self._convention_attractors(self.config["contact"], self.config["start"])

    def _convention_attractors(self, contact: str, start: str) -> xarray.Dataset:
        attractors = self.summary("attractors")
        return self.cached((contact, start), lambda: attractors.sel(contact=contact, start=start), attractors)

    def critical_a(self, law: str) -> tuple[float, float]:
        """Return a_c, at which synchrony loses stability, and its error; NaN if the study has no orbits."""
        if "orbits" not in self.summaries:
            return np.nan, np.nan
        orbits = self.summary("orbits").sel(law=law)
        return orbits["critical_a"].item(), orbits["critical_a_error"].item()

    def proved_critical_a(self, law: str) -> tuple[float, float] | None:
        """Return the proved a_c and its proved error bound; None if there is no proof for the law.

        Raises ValueError, one line, if the computed a_c lies outside: then one of the two is wrong.
        """
        if "proof" not in self.summaries or law not in self.summaries["proof"]["law"]:
            return None
        low, high = self.summaries["proof"]["critical_a"].sel(law=law).values.tolist()
        middle = 0.5 * (low + high)
        critical, error = self.critical_a(law)
        if abs(critical - middle) > error + CRITICAL_A_ROUNDING:
            raise ValueError(f"orbits.nc: critical_a: got {critical!r}, expected {low!r} to {high!r} by proof.nc")
        # Like a_c, the midpoint lies between the two, even if it is rounded.
        return middle, high - low


def check_covered(values: np.ndarray, a: Range, owner: str) -> None:
    """Raise NotTestableError, with what is missing, unless values of a cover a range.

    owner : what has the values, for the message
    """
    if gaps := a.missing(values):
        missing = join_words([gap.words for gap in gaps])
        raise NotTestableError(f"a statement on all {a} needs values of a {missing}, where {owner} has none")
    if a.is_bounded and (count := int(a.choose(values).sum())) < MIN_VALUES:
        raise NotTestableError(f"a statement on all {a} needs {MIN_VALUES} values of a; {owner} has {count} there")


def finite(values: Any) -> np.ndarray:
    """Return the finite values of an array, shape (n,)."""
    array = np.asarray(values, dtype=float).ravel()
    return array[np.isfinite(array)]
