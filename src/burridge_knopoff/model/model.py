"""The model: everything in the equations of motion, and the state of all blocks at one instant."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Annotated, Any, ClassVar

import numpy as np

from burridge_knopoff.laws import FormulaLaw, GivenLaw, Law, law_of
from burridge_knopoff.laws.law import MAX_SPEED, check_names, law_at_recorded_a, recorded_a
from burridge_knopoff.messages import format_value, full_key, refusal, suggestion
from burridge_knopoff.model.chain import NEIGHBOURS, Chain
from burridge_knopoff.model.fields import check_fields, fields_of, settings
from burridge_knopoff.model.initial import PAPER_V, InitialState, PaperState
from burridge_knopoff.model.parameters import (
    CHAIN_PARAMETERS,
    chain_parameter,
    format_parameter_names,
    parameter_key,
    parse_indexed_name,
    set_chain_parameters,
)
from burridge_knopoff.model.ranges import Number, OneOf, Text
from burridge_knopoff.values import Unchanging, instance_of, read_only_copy, real_array, real_number

LAW_NAME = Text("small letters, digits and _, at most 32, a letter first", "[a-z][a-z0-9_]{0,31}")

CONTACTS = ("one_sided", "symmetric")
#: steady: the driver moves at velocity v | quasistatic: the driver stops while any block slips
LOADINGS = ("steady", "quasistatic")
STARTS = ("moving", "tested")
#: The choices of `start` and their meaning.
START = (
    "moving: every block slips at tau = 0 | tested: blocks on which the force is at most the threshold stick at tau = 0"
)

#: Names that the numbers of a law cannot have: those of a model, and of the arguments of functions of a model.
RESERVED_NAMES = {
    *fields_of(Chain),
    "law",
    "chain",
    "v",
    "contact",
    "name",
    "model",
    "window",
    "initial",
    "start",
    "settings",
}

_ONE_NUMBER = "one number for the whole chain"


@settings
@dataclass(frozen=True, init=False, repr=False)
class Model(Unchanging):
    """A friction law and a chain, pulled by a driver of constant velocity.

    law : a `Law`, or a law in any form that `law_of` takes
    chain : see `Chain`; by default the paper's three blocks
    numbers : parameters of the law, such as a and sigma, and in place of `chain` those of `Chain`, such as blocks and
        coupling, or of one block or spring, `**{"mass[3]": 1.2}`

    A parameter of the law that has no default may be left open. Raises ValueError, one line, for anything out of range,
    for a number that neither the law nor the chain has, and for numbers of the chain beside `chain`.

    All quantities are dimensionless: times in units of 1/ω, U = kX/F(0), v in units of ωF(0)/k, as in the paper
    (Section II, Eqs. 1 and 2).

    >>> from burridge_knopoff import Chain, Model
    >>> Model("linearized", a=0.08)
    <Model of 3 blocks: linearized law, a = 0.08>
    >>> model = Model({"formula": "1 - c*tanh(a*u/c)"}, a=0.1, c=0.2, blocks=7, coupling=1.5, v=0.2)
    >>> print(model)
    <Model of 7 blocks: formula law 1 - c*tanh(a*u/c), a = 0.1, c = 0.2, v = 0.2, coupling = 1.5>
    >>> model.at(coupling=2.0, a=0.2).chain.coupling
    2.0
    >>> Model("nonlinear", a=0.08, chain=Chain(4)).sliding_offset.shape
    (4,)
    """

    #: A model for the message if something else is given.
    EXAMPLE: ClassVar[str] = 'Model("linearized", a=0.08)'

    law: Law
    chain: Chain
    v: Annotated[float, Number(1e-6, 1e3), "velocity of the driver"] = PAPER_V
    contact: Annotated[
        str,
        OneOf(CONTACTS),
        "one_sided: a block sticks while the force is at most its threshold, however strong a backward pull is | "
        "symmetric: it sticks while the modulus of the force is at most its threshold, and can slip backward",
    ] = "one_sided"

    def __init__(
        self,
        law: GivenLaw,
        *others: Any,
        chain: Chain | None = None,
        v: float = PAPER_V,
        contact: str = "one_sided",
        **numbers: Any,
    ) -> None:
        if others or isinstance(law, Chain):
            raise ValueError(
                "Model: got more than a law without a name, expected "
                'Model("linearized", a=0.08, blocks=3, …) or Model(law, chain=Chain(…), …)'
            )
        of_chain = {name: value for name, value in numbers.items() if name in fields_of(Chain)}
        indexed = {name: value for name, value in numbers.items() if parse_indexed_name(name)}
        if chain is not None and (beside := [*of_chain, *indexed]):
            raise ValueError(f"{beside[0]}: got {format_value(numbers[beside[0]])} beside a chain, which has its own")
        of_law = {name: value for name, value in numbers.items() if name not in of_chain and name not in indexed}
        names = law_of(law).names
        for name in names:
            if name in RESERVED_NAMES:
                raise ValueError(f"{name}: got a parameter of the law, expected another name than that of a setting")
        for name in of_law:
            if name not in names:
                raise _unknown_parameter(name, (*names, "v", "contact", *fields_of(Chain)))
        own = law_of(law, **of_law)
        if chain is None:
            shape = {"blocks": 3} if of_chain.keys().isdisjoint(("blocks", "grid", "springs")) else {}
            chain = set_chain_parameters(Chain(**{**shape, **of_chain}), indexed)
        for name, value in (
            ("law", own),
            ("chain", instance_of(chain, Chain, "chain")),
            ("v", v),
            ("contact", contact),
        ):
            object.__setattr__(self, name, value)
        check_fields(self)
        if not own.missing:
            self._check_law()

    def __repr__(self) -> str:
        return f"<Model of {self.blocks} block{'s' * (self.blocks > 1)}: {self.words}>"

    def _check_law(self) -> None:
        # Blocks slip at a few times v, and faster from distant states: a run ends where the law is not analytic.
        fastest = MAX_SPEED * self.v
        if fastest > MAX_SPEED and not self.law.tape.is_analytic(0.0, fastest):
            raise ValueError(
                f"v: got {self.v!r}, expected a velocity up to ten times which the law {self.law.name} is analytic"
            )
        fastest = max(fastest, MAX_SPEED)
        slowest_argument, fastest_argument = (factor * fastest for factor in self.chain.weakening_range)
        if (slowest_argument < 0.0 or fastest_argument > fastest) and not self.law.tape.is_analytic(
            slowest_argument, fastest_argument
        ):
            expected = f"factors of all speeds up to {fastest:g} with which the law {self.law.name} is analytic"
            raise refusal("chain.weakening", self.chain.weakening, expected)

    @property
    def blocks(self) -> int:
        """Number of blocks."""
        return self.chain.blocks

    @property
    def parameter_names(self) -> tuple[str, ...]:
        """Names of the parameters of the law, the driver and the whole chain."""
        return (*self.law.names, "v", *CHAIN_PARAMETERS)

    def has_parameter(self, name: str) -> bool:
        """Whether the law, the driver or the chain has a parameter of this name."""
        return name in self.parameter_names or parse_indexed_name(name) is not None

    @property
    def place(self) -> str:
        """The model in messages: a, or v under a law without a."""
        name = "a" if "a" in self.law.parameters else "v"
        return f"{name} = {self.parameter(name)!r}"

    @property
    def words(self) -> str:
        """The model in a line: its law, and all that is not the paper's except the number of blocks.

        >>> from burridge_knopoff import Model
        >>> Model("stribeck", a=0.08, sigma=0.02, v=0.5, mass=(1.0, 1.0, 1.2)).words
        'stribeck law, a = 0.08, sigma = 0.02, v = 0.5, mass = (1.0, 1.0, 1.2)'
        """
        law, defaults = self.law, self.law.defaults
        values: dict[str, Any] = {key: value for key, value in law.parameters.items() if value != defaults.get(key)}
        for part in (self, self.chain):
            for key, of_model in fields_of(type(part)).items():
                if key != "blocks" and getattr(part, key) not in (of_model.default, None):
                    values[key] = getattr(part, key)
        own = f" {law.formula}" if isinstance(law, FormulaLaw) else ""
        numbers = (f"{key} = {format_value(value)}" for key, value in values.items())
        return ", ".join([f"{law.name} law{own}", *(f"{key} open" for key in law.missing), *numbers])

    def parameter(self, name: str) -> float:
        """Return the value of a parameter.

        Raises ValueError, one line, if the model has no parameter of this name, or several values for it.
        """
        value = self._stored_parameter(name)
        number = real_number(value)
        if number != number:
            raise refusal(name, value, _ONE_NUMBER)
        return number

    def _stored_parameter(self, name: str) -> Any:
        """Return a parameter as the model stores it: a number, several numbers or a word."""
        if not self.has_parameter(name):
            raise _unknown_parameter(name, self.parameter_names)
        if parameter_key(name) in CHAIN_PARAMETERS:
            return chain_parameter(self.chain, name)
        if name in self.law.missing:
            self.law.check_complete()
        return self.v if name == "v" else self.law.parameters[name]

    def at(self, *others: Any, **parameters: float) -> Model:
        """Return the same model at other values of any parameters, such as `at(a=0.1, v=0.2, coupling=1.5)`.

        `pulling` may be a number in place of `neighbours`. A value for one spring or block, `at(**{"mass[3]": 1.2})`,
        takes precedence over a value for all of them. Raises ValueError, one line, for a name that is not a parameter
        of the model, a value out of range, and a parameter of the whole chain that has several values.
        """
        check_names(others)
        of_driver: dict[str, Any] = {}
        of_chain: dict[str, Any] = {}
        of_law: dict[str, Any] = {}
        for name, value in parameters.items():
            if name not in self.law.missing:
                stored = self._stored_parameter(name)
                if not isinstance(stored, float) and stored != NEIGHBOURS:
                    raise refusal(name, stored, _ONE_NUMBER)
            if real_number(value) != real_number(value):
                raise refusal(name, value, "a number")
            part = of_driver if name == "v" else of_chain if parameter_key(name) in CHAIN_PARAMETERS else of_law
            part[name] = value
        # What does not change keeps its cached properties.
        law = self.law.at(**of_law) if of_law else self.law
        chain = set_chain_parameters(self.chain, of_chain) if of_chain else self.chain
        return replace(self, chain=chain, law=law, **of_driver)

    def check_same(self, other: Model, key: str) -> None:
        """Check that another model is the same, whatever the form in which its chain is given.

        Raises ValueError, one line, with a part in which it differs and `key` as its name.
        """
        part = self.chain.different_key(other.chain)
        of_chain = [] if part is None else [(f"chain.{part}", getattr(self.chain, part), getattr(other.chain, part))]
        numbers = [(name, self.law.parameters.get(name), other.law.parameters.get(name)) for name in self.law.names]
        parts = [(name, getattr(self, name), getattr(other, name)) for name in ("law", "v", "contact")]
        for name, value, other_value in (*of_chain, *numbers, *parts):
            # A chain may differ in its form only.
            if value != other_value or name.startswith("chain."):
                raise refusal(f"{key}.{name}", other_value, f"{format_value(value)}, as in the model")

    @property
    def has_closed_form(self) -> bool:
        """Whether the motion between events is a sum of oscillating modes, as the solver `map` requires."""
        return self.law.is_linear and self.chain.is_uniform and abs(self.law.initial_slope) < self.chain.damping_limit

    @property
    def scale(self) -> float:
        """Factor for distances that are given for v = 0.1: under the linearized law distances are proportional to v."""
        return self.v / PAPER_V

    @property
    def state_scale(self) -> np.ndarray:
        """Factors for differences of positions and velocities that are given for v = 0.1 in the chain's own units,
        shape (2 blocks,).
        """
        units = self.chain.own_units
        return self.scale / units.velocity * units.state(self.blocks)

    def friction(self, speed: np.ndarray) -> np.ndarray:
        """Return Φ(w_i u_i) of blocks that slip at speeds u_i, relative to their thresholds, shape (…, blocks)."""
        return self.law(self.chain.weakenings * speed)

    def friction_slope(self, speed: np.ndarray) -> np.ndarray:
        """Return the derivative of `friction` with respect to the speed of each block, shape (…, blocks)."""
        return self.chain.weakenings * self.law.slope(self.chain.weakenings * speed)

    def least_friction(self, fastest: float) -> float:
        """Return the least Φ(w_i u) of all blocks at speeds u from 0 to `fastest`."""
        return min(self.law.least_friction(factor * fastest) for factor in set(self.chain.weakening_range))

    @cached_property
    def sliding_friction(self) -> np.ndarray:
        """The friction Φ(w_i v) of uniform sliding, shape (blocks,)."""
        return read_only_copy(self._friction_at(self.v))

    def _friction_at(self, v: float) -> np.ndarray:
        # Evaluated once if the blocks are equal: rounding of powers in arrays differs from that of single numbers.
        if isinstance(self.chain.weakening, float):
            return np.full(self.blocks, float(self.law(self.chain.weakening * v)))
        return self.friction(np.full(self.blocks, v))

    @cached_property
    def sliding_offset(self) -> np.ndarray:
        """Positions e of uniform sliding relative to the driver, shape (blocks,)."""
        return read_only_copy(self.chain.sliding_offset(self.sliding_friction))

    def begin(self, initial: InitialState, start: str = "moving", loading: str = "steady") -> ChainState:
        """Return the state at τ = 0 of a run from an initial state.

        start : moving or tested, see START
        loading : steady or quasistatic; in the second case the driver rests, and dashpots to it pull at no block that
            sticks

        Raises ValueError if the state does not fit the chain, or slips backward under one-sided contact.
        """
        OneOf(STARTS).form(start, "start")
        OneOf(LOADINGS).form(loading, "loading")
        u, w = self.initial_coordinates(initial)
        stuck = self.stuck_blocks(u, w, start, loading)
        return ChainState(u - self.sliding_offset, np.where(stuck, 0.0, w), stuck)

    def dropped_velocities(self, initial: InitialState, start: str) -> str:
        """Return a remark on the given velocities of blocks that stick at τ = 0, which do not count; empty if none do.

        The velocities of a state of the paper are not given.
        """
        if start == "moving" or isinstance(initial, PaperState):
            return ""
        u, w = self.initial_coordinates(initial)
        dropped = np.flatnonzero(self.stuck_blocks(u, w, start) & (w != 0.0)) + 1
        if not len(dropped):
            return ""
        blocks = f"block {dropped[0]} sticks" if len(dropped) == 1 else f"{len(dropped)} blocks stick"
        return f"start tested: in the state {initial.name} {blocks} at tau = 0, with velocity 0 in place of that given"

    def initial_coordinates(self, initial: InitialState) -> tuple[np.ndarray, np.ndarray]:
        """Return U(0) and U'(0) of an initial state, each of shape (blocks,); a `PaperState` follows v.

        Raises ValueError as `begin` does.
        """
        u, w = initial.coordinates(self.blocks)
        # Even with a factor of 1 the sum would round the numbers of the paper.
        if isinstance(initial, PaperState) and self.v != PAPER_V:
            of_paper = self.chain.sliding_offset(self._friction_at(PAPER_V))
            u, w = self.sliding_offset + self.scale * (u - of_paper), self.scale * w
        self.check_directions(w, "velocity")
        return u, w

    def check_directions(self, velocity: np.ndarray, key: str, rounding: float = 0.0) -> None:
        """Check that no block slips backward under one-sided contact.

        rounding : largest backward velocity that counts as 0

        Raises ValueError, one line, if a block slips backward.
        """
        if self.contact == "one_sided" and velocity.min() < -rounding:
            raise ValueError(
                f"{key}: got {float(velocity.min())!r}, expected at least 0 under contact one_sided: blocks only slip "
                "forward; contact symmetric lets them slip backward"
            )

    def stuck_blocks(
        self, position: np.ndarray, velocity: np.ndarray, start: str, loading: str = "steady"
    ) -> np.ndarray:
        """Return a mask of the blocks that stick at τ = 0 for a choice of `start`; U(0), U'(0) and mask: (…, blocks).

        The force includes the dashpots, with the block at rest and its neighbours moving unless they stick as well.
        """
        chain, v = self.chain, self.v if loading == "steady" else 0.0
        # Spring forces from U itself: rounding in co-moving coordinates could move a block across its threshold.
        force = chain.force(position)
        stuck = np.zeros(position.shape, dtype=bool)
        if start == "moving":
            return stuck
        if not chain.is_damped:
            return force <= chain.thresholds
        for _ in range(self.blocks):
            speed = np.where(stuck, 0.0, velocity)
            at_rest = force + chain.damping_force(speed, v) + chain.damping_diagonal * speed
            grown = stuck | (at_rest <= chain.thresholds)
            if np.array_equal(grown, stuck):
                break
            stuck = grown
        return stuck


def recorded_value(model: Model, parameter: str) -> float:
    """Return a parameter of a model as files have it: a is 0 under a law without it."""
    return recorded_a(model.law) if parameter == "a" else model.parameter(parameter)


def _unknown_parameter(name: str, names: Sequence[str]) -> ValueError:
    if name in ("contact", *fields_of(Chain)):
        return ValueError(
            f"{name}: not a parameter that varies, expected it where the model is built: Model(…, {name}=…)"
        )
    return ValueError(
        f"{full_key('', name)}: not a parameter of this model, expected {format_parameter_names(names)}"
        f"{suggestion(name, names)}"
    )


def at_recorded_a(model: Model, a: float) -> Model:
    """Return a model at an a of a file or a study, in which a law without a has any: it is the same at all."""
    return replace(model, law=law_at_recorded_a(model.law, a))


@dataclass(frozen=True, eq=False)
class ChainState:
    """The state of all blocks at one instant of a motion, from which a run can continue; arrays of shape (blocks,).

    `Model.begin` makes a ChainState from an `InitialState` and decides which blocks stick.

    position : co-moving x_i = U_i − vτ − e_i; velocity : U_i'; stuck : whether each block sticks
    time : τ of the state; a continued run starts its clock here

    Positions and velocities are in the units of `Model`; e_i is its `sliding_offset`. `Trajectory.final` also keeps the
    last step of its run, which `simulate(model, initial=run.final)` repeats. A run in two parts therefore has the same
    states, events and crossings as the whole run, bit for bit, even if the state was copied or pickled.

    >>> from burridge_knopoff import InitialState, Model
    >>> model = Model("linearized", a=0.08)
    >>> at = model.begin(InitialState("own", (-0.9, -1.1, -1.0), (0.1, 0.1, 0.1)), start="tested")
    >>> at.stuck.tolist(), at.velocity.tolist()
    ([True, False, True], [0.0, 0.1, 0.0])
    """

    position: np.ndarray
    velocity: np.ndarray
    stuck: np.ndarray
    time: float = 0.0
    # The solver of the run and the start of its last step. They are valid for this state only: `replace` drops them.
    last_step: Any = field(default=None, init=False, repr=False)

    def __post_init__(self) -> None:
        for name in ("position", "velocity", "stuck"):
            if type(value := getattr(self, name)) is not np.ndarray:
                array = np.asarray(value, dtype=bool) if name == "stuck" else real_array(value, f"state.{name}")
                object.__setattr__(self, name, array)

    def __repr__(self) -> str:
        return (
            f"<ChainState at tau = {self.time:g}: {np.size(self.position)} blocks, {np.sum(self.stuck)} of them stuck>"
        )

    def mirrored(self) -> ChainState:
        """Return the state seen from the other end of the chain."""
        return ChainState(self.position[::-1].copy(), self.velocity[::-1].copy(), self.stuck[::-1].copy(), self.time)

    def vector(self) -> np.ndarray:
        """Return positions and velocities in one array, shape (2 blocks,)."""
        return np.concatenate([self.position, self.velocity])
