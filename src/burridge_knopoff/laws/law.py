"""What a friction law is: a formula for Φ in the slip speed and the friction parameter a.

Everything else follows from the formula: its slope, the Taylor series of both in the kernel, how a slip starts and
where friction is least. A law of one's own is a class with a formula, or a formula in a config.
"""

from __future__ import annotations

import unicodedata
from collections.abc import Mapping
from functools import cached_property
from types import MappingProxyType
from typing import ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike

from burridge_knopoff.laws.formula import FormulaError, names_of, tape_of
from burridge_knopoff.laws.tape import Tape
from burridge_knopoff.values import instance_of, joined, real_number, refusal, shown

#: Speeds up to which a law has to be analytic; no block of a chain with springs and thresholds of about 1 comes there.
FASTEST = 10.0

# Friction at rest may be above 1 by the rounding of its formula.
ROUNDING = 1e-12

# Speeds at which the least friction is first looked for.
SAMPLES = 256
_SHARES = np.linspace(0.0, 1.0, SAMPLES + 1)


class Law:
    """Friction Φ on a slipping block at speed U', as a share of the static friction: what all laws have in common.

    a : friction parameter, at least 0
    name : by which the law is known in a study and in its files; without it that of its class
    numbers : for the names that the formula uses besides `a` and `u`; without them those of its class

    Raises ValueError for a number that is not finite, for Φ(0), the friction on a block that starts, unless it is above
    0 and at most 1, and where Φ is not analytic and finite for all speeds up to FASTEST.

    A law is a function of the speed, in units of ωF(0)/k; `at` gives it at another a. Laws that are built in come from
    `law_of`, and name their source; a law of one's own is a `FormulaLaw`, or a subclass with `formula` and `text`.

    >>> from burridge_knopoff import Law, law_of
    >>> law = law_of("nonlinear", 0.25)
    >>> isinstance(law, Law), law([0.0, 1.0, 4.0]).tolist(), float(law.slope(0.0))
    (True, [1.0, 0.8, 0.5], -0.25)
    >>> law.at(0.5).a
    0.5
    """

    #: Φ in the syntax of a config: u is U', a the friction parameter.
    formula: str
    #: The same as a reader wants it, in plain text.
    text: str
    #: The other numbers of the formula, with their defaults.
    defaults: ClassVar[Mapping[str, float]] = {}
    #: Characters that the formula may have.
    longest: ClassVar[int] = 400

    def __init__(self, a: float, /, *, name: str = "", **numbers: float) -> None:
        self.name = name or type(self).__module__.rpartition(".")[2]
        for key in numbers.keys() - self.defaults.keys():
            allowed = " | ".join(self.defaults) or "none"
            raise ValueError(f"{joined(self.name, key)}: not a number of this law: {allowed}")
        self._set(a, {**self.defaults, **numbers})

    def _set(self, a: float, numbers: Mapping[str, float]) -> None:
        for key in ("formula", "text"):
            if key not in vars(self) and not hasattr(type(self), key):
                raise ValueError(f"{self.name}.{key}: missing; needed: a text")
        known = names_of(self.formula)
        for key in numbers:
            if key in ("a", "u"):
                place = joined(self.name, key)
                raise ValueError(f"{place}: got a name that is taken, expected another one for a number")
            if key not in known:
                raise ValueError(f"{joined(self.name, key)}: not in the formula {shown(self.formula)}")
        for key, value in {"a": a, **numbers}.items():
            if not abs(real_number(value)) < 1e300:
                raise refusal(key, value, "a finite number")
        if real_number(a) < 0.0:
            raise refusal("a", a, "0 or more")
        # Adding 0 turns -0.0 into 0.0: the same number must not make two different files.
        self.a = real_number(a) + 0.0
        self._numbers = {key: real_number(value) + 0.0 for key, value in numbers.items()}
        try:
            self._check()
        except FormulaError as error:
            raise ValueError(
                f"{self.name}: got {shown(self.formula)} at a = {self.a:g}, expected a law of friction: {error}"
            ) from None

    def _check(self) -> None:
        if len(self.formula) > self.longest:
            raise FormulaError(f"at most {self.longest} characters")
        if not self.tape.is_analytic(0.0, FASTEST):
            raise FormulaError(f"it is not analytic and finite for all speeds u from 0 to {FASTEST:g}")
        start = float(self(0.0))
        if not 0.0 < start <= 1.0 + ROUNDING:
            raise FormulaError(f"at u = 0 it is {start:g}: above 0 and at most 1, the static friction")

    def __setattr__(self, name: str, value: object) -> None:
        # What follows from a and the numbers is computed once.
        if "_numbers" in vars(self):
            raise AttributeError(f"{name}: a law does not change once it is made; `at` gives it at another a")
        super().__setattr__(name, value)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Law) and self._key == other._key

    def __hash__(self) -> int:
        return hash(self._key)

    def __repr__(self) -> str:
        numbers = "".join(f", {key}={value!r}" for key, value in self.numbers.items())
        return f"<law {self.name}: {self.formula}, a={self.a!r}{numbers}>"

    @property
    def numbers(self) -> Mapping[str, float]:
        """Values of the names that the formula uses besides `a` and `u`."""
        return MappingProxyType(self._numbers)

    @property
    def words(self) -> str:
        """How the law reads, with its numbers: «Φ = (1 − σ)/(1 + aU′/(1 − σ)), σ = 0.01»."""
        return ", ".join([self.text, *(f"{_letter(key)} = {value:g}" for key, value in self.numbers.items())])

    @property
    def _key(self) -> tuple[object, ...]:
        return self.name, self.formula, self.a, tuple(self.numbers.items())

    def at(self, a: float) -> Self:
        """Return the same law with another friction parameter."""
        other = object.__new__(type(self))
        other.name, other.formula = self.name, self.formula
        other._set(a, self.numbers)
        return other

    @cached_property
    def tape(self) -> Tape:
        """The operations that make Φ and its slope of a speed."""
        return tape_of(self.formula, {"a": self.a, **self.numbers})

    def __call__(self, speed: ArrayLike) -> np.ndarray:
        """Return Φ at speeds U' ≥ 0, elementwise."""
        speed = np.asarray(speed, dtype=float)
        return self.tape.run(speed)[0] + np.zeros_like(speed)

    def slope(self, speed: ArrayLike) -> np.ndarray:
        """Return dΦ/dU' at speeds U' ≥ 0, elementwise; negative where friction weakens."""
        speed = np.asarray(speed, dtype=float)
        return self.tape.run(speed)[1] + np.zeros_like(speed)

    @property
    def is_linear(self) -> bool:
        """Whether Φ is a straight line, so that the motion between events has a closed form."""
        return self.tape.is_linear

    @cached_property
    def steepest(self) -> float:
        """The largest modulus of the slope at speeds that may occur."""
        return float(np.abs(self.slope(np.linspace(0.0, FASTEST, 4 * SAMPLES + 1))).max())

    def least(self, fastest: float) -> float:
        """Return the least friction at speeds from 0 to the fastest."""
        speed = fastest * _SHARES
        # A run without bound may reach speeds at which the law is not defined.
        with np.errstate(invalid="ignore"):
            friction = self(speed)
            lowest = int(np.where(np.isnan(friction), np.inf, friction).argmin())
            around = self.slope(speed[max(lowest - 1, 0) : lowest + 2])
        # Where friction is constant to rounding there is no sign to change.
        if not (len(around) == 3 and around[0] < 0.0 < around[2]):
            return float(friction[lowest])
        from scipy.optimize import brentq

        return float(self(brentq(lambda u: float(self.slope(u)), speed[lowest - 1], speed[lowest + 1], xtol=1e-15)))


class FormulaLaw(Law):
    """A law given by its formula, under a name, with numbers for all names in it but `a` and `u`.

    Raises ValueError as `Law` does, and for a formula with anything in it that is not allowed there.

    Allowed are numbers, brackets, `+`, `-`, `*`, `/`, `**`, and exp, log, sqrt and tanh; u is the speed U'.

    >>> from burridge_knopoff import FormulaLaw
    >>> law = FormulaLaw(0.04, "1/(1 + a*u)**p", name="power", p=2.0)
    >>> law, round(float(law(5.0)), 4)
    (<law power: 1/(1 + a*u)**p, a=0.04, p=2.0>, 0.6944)
    """

    def __init__(self, a: float, formula: str, /, *, name: str = "formula", **numbers: float) -> None:
        self.name = name
        self.formula = instance_of(formula, str, "formula")
        self._set(a, numbers)

    @property
    def text(self) -> str:  # type: ignore[override]
        """The formula with its numbers."""
        numbers = "".join(f", {key} = {value:g}" for key, value in self.numbers.items())
        return f"Φ = {self.formula}, u = U′{numbers}"

    @property
    def words(self) -> str:
        """The same: the formula names its numbers itself."""
        return self.text


def _letter(name: str) -> str:
    try:
        return unicodedata.lookup(f"GREEK SMALL LETTER {name}")
    except KeyError:
        return name
