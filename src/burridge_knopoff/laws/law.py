"""Friction laws: a formula for Φ in the slip speed and numbers such as the friction parameter a.

Everything else follows from the formula: the slope, the Taylor series of both in the kernel, the start of a slip, and
the least friction. A new law is a class with a formula, or a formula in a config.
"""

from __future__ import annotations

import unicodedata
from collections.abc import Mapping, Sequence
from functools import cached_property
from types import MappingProxyType
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike

from burridge_knopoff.laws.formula import MOST_CHARACTERS, FormulaError, check_formula, compile_formula, formula_names
from burridge_knopoff.laws.tape import Tape
from burridge_knopoff.messages import cut, format_value, full_key, refusal
from burridge_knopoff.values import Unchanging, instance_of, real_array, real_number

#: A law must be analytic up to this speed. Blocks stay slower if springs and thresholds are about 1.
MAX_SPEED = 10.0
#: Blocks whose friction grows stay below the speed at which it reaches this many thresholds, the force on a block.
MAX_FRICTION = 10.0

# Φ(0) may exceed 1 by this much because of rounding in the formula.
ROUNDING = 1e-12

# Number of speeds at which the least friction is first sampled.
SAMPLES = 256
_FRACTIONS = np.linspace(0.0, 1.0, SAMPLES + 1)


class Law(Unchanging):
    """Base class of all laws: friction Φ on a block slipping at speed U', as a fraction of its static friction.

    name : name of the law in a study and in its files; by default the name of its module
    parameters : values of the numbers in the formula, such as a; by default those of the class

    A number without a default may be left open: it is `missing`, and what needs it says so. Raises ValueError, one
    line, for a parameter that is not finite, for a below 0, if the friction Φ(0) at the start of a slip is not above 0
    and at most 1, and if Φ is not analytic and finite for all speeds up to MAX_SPEED.

    A law is a function of the speed, in units of ωF(0)/k; `at` returns the law at other values of its parameters.
    `law_of` returns the built-in laws, whose modules give the sources. A new law is a `FormulaLaw`, or a subclass with
    `formula` and `text`.

    >>> from burridge_knopoff import Law, law_of
    >>> law = law_of("nonlinear", a=0.25)
    >>> isinstance(law, Law), law([0.0, 1.0, 4.0]).tolist(), float(law.slope(0.0))
    (True, [1.0, 0.8, 0.5], -0.25)
    >>> law.at(a=0.5).parameters["a"], law_of("nonlinear").missing
    (0.5, ('a',))
    """

    #: Φ in the syntax of a config; u is U'.
    formula: str
    #: The same as it is printed, in plain text.
    text: str
    #: Defaults of the parameters in the formula, of those that have one.
    defaults: ClassVar[Mapping[str, float]] = {}
    #: Maximum length of the formula in characters.
    max_length: ClassVar[int] = MOST_CHARACTERS

    def __init__(self, /, *others: Any, name: str = "", **parameters: float) -> None:
        check_names(others)
        self.name = name or type(self).__module__.rpartition(".")[2]
        self._set({**self.defaults, **parameters})

    def _set(self, parameters: Mapping[str, float]) -> None:
        for key in ("formula", "text"):
            if key not in vars(self) and not hasattr(type(self), key):
                raise ValueError(f"{self.name}.{key}: missing, expected a text")
        if "u" in parameters:
            place = full_key(self.name, "u")
            raise ValueError(f"{place}: got a reserved name, expected another name for the parameter")
        try:
            check_formula(self.formula, self.max_length)
        except FormulaError as error:
            raise self._refusal(error, parameters.get("a")) from None
        names = formula_names(self.formula) - {"u"}
        for key, value in parameters.items():
            if key not in names:
                allowed = " | ".join(map(cut, sorted(names))) or "none"
                raise ValueError(f"{full_key(self.name, key)}: not a parameter of this law, expected {allowed}")
            if not abs(real_number(value)) < 1e300:
                raise refusal(key, value, "a finite number")
        if real_number(parameters.get("a", 0.0)) < 0.0:
            raise refusal("a", parameters["a"], "0 or more")
        #: Names of the parameters that have no value, in alphabetical order.
        self.missing = tuple(sorted(names - parameters.keys()))
        # Adding 0 turns -0.0 into 0.0: equal parameters must give equal files.
        values = {key: real_number(value) + 0.0 for key, value in parameters.items()}
        self._parameters = {**({"a": values["a"]} if "a" in values else {}), **values}
        try:
            self._check()
        except FormulaError as error:
            raise self._refusal(error, values.get("a")) from None

    def _refusal(self, error: FormulaError, a: float | None) -> ValueError:
        at = "" if a is None else f" at a = {a:g}"
        return ValueError(f"{self.name}: got {format_value(self.formula)}{at}, expected a friction law: {error}")

    def _check(self) -> None:
        if self.missing:
            return
        if not self.tape.is_analytic(0.0, MAX_SPEED):
            raise FormulaError(f"the formula is not analytic and finite for all speeds u from 0 to {MAX_SPEED:g}")
        start = float(self(0.0))
        if not 0.0 < start <= 1.0 + ROUNDING:
            raise FormulaError(f"its value at u = 0 is {start:g}, not above 0 and at most 1 (the static friction)")

    def __setattr__(self, name: str, value: object) -> None:
        # Values derived from the parameters are cached.
        if "_parameters" in vars(self):
            raise AttributeError(f"{name}: a law cannot be changed; `at` returns the law at other values")
        super().__setattr__(name, value)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Law) and self._key == other._key

    def __hash__(self) -> int:
        return hash(self._key)

    def __repr__(self) -> str:
        parameters = "".join(f", {key}={value!r}" for key, value in self.parameters.items())
        return f"<law {self.name}: {self.formula}{parameters}>"

    @property
    def parameters(self) -> Mapping[str, float]:
        """Values of the parameters in the formula, of those that have one; a is the first."""
        return MappingProxyType(self._parameters)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of all parameters in the formula; a is the first."""
        return tuple(sorted([*self._parameters, *self.missing], key=lambda name: name != "a"))

    @property
    def words(self) -> str:
        """The law as it is printed, with its parameters but a: «Φ = (1 − σ)/(1 + aU′/(1 − σ)), σ = 0.01»."""
        others = ((key, value) for key, value in self.parameters.items() if key != "a")
        return ", ".join([self.text, *(f"{_greek_letter(key)} = {value:g}" for key, value in others)])

    @property
    def _key(self) -> tuple[object, ...]:
        # In whatever order they were given, at once or one after the other.
        return self.name, self.formula, frozenset(self.parameters.items())

    def at(self, *others: Any, **parameters: float) -> Self:
        """Return the same law with other values of some of its parameters."""
        check_names(others)
        other = object.__new__(type(self))
        other.name, other.formula = self.name, self.formula
        other._set({**self.parameters, **parameters})
        return other

    def check_complete(self, *supplied: str) -> None:
        """Raise ValueError, one line, if a parameter has no value and is not one of those that are supplied later."""
        for key in self.missing:
            if key not in supplied:
                raise ValueError(f"{key}: missing, expected a number: the law {self.name} contains it")

    @cached_property
    def tape(self) -> Tape:
        """The operations that compute Φ and its slope from a speed."""
        self.check_complete()
        return compile_formula(self.formula, self.parameters, longest=self.max_length)

    def __call__(self, speed: ArrayLike) -> np.ndarray:
        """Return Φ at speeds U', elementwise; they are below 0 only for blocks with negative weakening."""
        speed = real_array(speed, "speed")
        return _of_shape(self.tape.run(speed)[0], speed.shape)

    def slope(self, speed: ArrayLike) -> np.ndarray:
        """Return dΦ/dU' at such speeds, elementwise; negative where friction weakens."""
        speed = real_array(speed, "speed")
        return _of_shape(self.tape.run(speed)[1], speed.shape)

    @property
    def is_linear(self) -> bool:
        """Whether Φ is linear in the speed, so that the motion between events has a closed form."""
        return self.tape.is_linear

    def steepest_slope(self, low: float, high: float) -> float:
        """Return the largest modulus of the slope at speeds from `low` to `high`.

        Speeds below 0 count up to a friction of MAX_FRICTION.
        """
        speed = np.linspace(low, high, 4 * SAMPLES + 1)
        reached = (speed >= 0.0) | (self(speed) <= MAX_FRICTION)
        return float(np.abs(self.slope(speed[reached])).max())

    @cached_property
    def initial_slope(self) -> float:
        """The slope at the start of a slip."""
        return float(self.slope(0.0))

    def least_friction(self, fastest: float) -> float:
        """Return the least friction at speeds from 0 to `fastest`."""
        speed = fastest * _FRACTIONS
        # A diverging run may reach speeds at which the law is not defined.
        friction = self(speed)
        lowest = int(np.where(np.isnan(friction), np.inf, friction).argmin())
        around = self.slope(speed[max(lowest - 1, 0) : lowest + 2])
        # Where friction is constant up to rounding, the slope does not change sign.
        if not (len(around) == 3 and around[0] < 0.0 < around[2]):
            return float(friction[lowest])
        from scipy.optimize import brentq

        return float(self(brentq(lambda u: float(self.slope(u)), speed[lowest - 1], speed[lowest + 1], xtol=1e-15)))


class FormulaLaw(Law):
    """A law given by its formula, with a name and the values of the names in the formula except `u`.

    Raises ValueError as `Law` does, and for syntax that is not allowed in a formula.

    A formula may contain numbers, parentheses, `+`, `-`, `*`, `/`, `**`, exp, log, sqrt and tanh; u is the speed U'.

    >>> from burridge_knopoff import FormulaLaw
    >>> law = FormulaLaw("1/(1 + a*u)**p", name="power", a=0.04, p=2.0)
    >>> law, round(float(law(5.0)), 4)
    (<law power: 1/(1 + a*u)**p, a=0.04, p=2.0>, 0.6944)
    """

    def __init__(self, formula: str, /, *others: Any, name: str = "formula", **parameters: float) -> None:
        check_names(others)
        self.name = name
        self.formula = instance_of(formula, str, "formula")
        self._set(parameters)

    @property
    def text(self) -> str:  # type: ignore[override]
        """The formula with the values of its parameters but a."""
        parameters = "".join(f", {key} = {value:g}" for key, value in self.parameters.items() if key != "a")
        return f"Φ = {self.formula}, u = U′{parameters}"

    @property
    def words(self) -> str:
        """The same as `text`, which already gives the parameters."""
        return self.text


def check_names(others: Sequence[Any]) -> None:
    """Refuse parameters without a name; raises ValueError, one line."""
    if others:
        raise ValueError(f"parameters: got {format_value(others[0])} without a name, expected a name, such as a=0.08")


def _of_shape(value: np.ndarray, shape: tuple[int, ...]) -> np.ndarray:
    """Return a value of this shape; a law may be constant. Adding 0 turns −0 into 0."""
    return value + 0.0 if np.shape(value) == shape else np.full(shape, value + 0.0)


def _greek_letter(name: str) -> str:
    try:
        return unicodedata.lookup(f"GREEK SMALL LETTER {name}")
    except KeyError:
        return name


def recorded_a(law: Law) -> float:
    """Return a of a law as files and their names have it: 0 for a law without a."""
    law.check_complete()
    return law.parameters.get("a", 0.0)


def law_at_recorded_a(law: Law, a: float) -> Law:
    """Return a law at an a of a file or a study, in which a law without a has any: it is the same at all."""
    return law.at(a=a) if "a" in law.names else law
