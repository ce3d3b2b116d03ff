"""Proof of the loss of synchrony: the a at which the transverse multiplier is 1, and its uniqueness in a range of a.

Near a_c the equations of the orbit and of the multiplier are solved together for the orbit and a. The range of a is
covered by balls. For all a in a ball there is an orbit, the orbits of neighbouring balls agree where the balls touch,
and the multiplier increases with a throughout. It therefore equals 1 only once.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from flint import arb, fmpq

from burridge_knopoff.periodic_orbits.periodic import PeriodicOrbit
from burridge_knopoff.proof.arcs import Arc
from burridge_knopoff.proof.balls import ProofError, arithmetic, ball_between
from burridge_knopoff.proof.krawczyk import (
    Enclosure,
    derivatives,
    enclose,
    enclose_widest,
    refine_guess,
    solve_linear,
    submatrix,
    trial_radii,
)
from burridge_knopoff.proof.orbit import ProvedOrbit, arcs_of, equations

# Largest width of the pieces of a range of a, and largest number of halvings.
LARGEST_PIECE = fmpq(1, 400)
MAX_HALVINGS = 16
# Half-width of the box around the orbit at a single a.
BOX_RADIUS = 2.0**-40


@dataclass(frozen=True, eq=False)
class CriticalOrbit:
    """The proved loss of synchrony.

    orbit : the synchronized orbit at a_c, whose a is a_c; it has exactly the events of its arcs
    uniqueness_range : a ball of a in which no other orbit near this one has the multiplier 1
    """

    orbit: ProvedOrbit
    uniqueness_range: arb

    @property
    def a(self) -> arb:
        """The friction parameter a_c, a ball."""
        return self.orbit.a


@dataclass(frozen=True, eq=False)
class Piece:
    """The proved synchronized orbits for all a in a ball.

    orbit : enclosure of all these orbits
    middle, direction : the unknowns of the orbit at the midpoint of the ball, and their derivative with respect to a
    box : the box around this tangent in which the orbit is unique at each a
    """

    orbit: ProvedOrbit
    middle: Sequence[arb]
    direction: Sequence[arb]
    box: Sequence[arb]

    def check_contains(self, other: Enclosure, a: arb) -> None:
        """Prove that an orbit enclosed at an a in the ball is that of the piece; raises ProofError if this fails."""
        with arithmetic():
            box = _point_near_tangent(self.middle, self.direction, a - self.orbit.a.mid(), self.box)
            if not self.orbit.a.contains(a) or not all(map(arb.contains, box, other.inner)):
                raise ProofError(f"a = {a}: not proved to be an orbit of the family")


def prove_critical(orbit: PeriodicOrbit) -> CriticalOrbit:
    """Return the proof that the multiplier of the synchronized orbit crosses 1 at an a near that of a given orbit.

    orbit : in double precision, near a_c
    Raises ProofError, one line, if the proof fails.
    """
    arcs, guess = arcs_of(orbit)
    system = equations(arcs, critical=True)
    enclosure = enclose_widest(system, refine_guess(system, [*guess, orbit.a]), arcs[0].flow.box_radii)
    proved = ProvedOrbit(arcs, enclosure.inner[-1], Enclosure(enclosure.inner[:-1], enclosure.outer[:-1]))
    proved.check_arcs()
    if not abs(proved.slope) > 0:
        raise ProofError(f"a = {proved.a}: not proved that the multiplier crosses 1: its slope is {proved.slope}")
    return CriticalOrbit(proved, enclosure.outer[-1])


def prove_branch(orbit: PeriodicOrbit, low: fmpq, high: fmpq) -> list[Piece]:
    """Return the proofs that the synchronized orbit exists and that its multiplier increases, for a from low to high.

    The box of each piece contains one orbit, and neighbouring pieces share the orbit at the a where they touch.

    orbit : in double precision, at an a near the low end; the order of its events is assumed for the whole range
    Raises ProofError, one line, if the proof fails.
    """
    arcs, guess = arcs_of(orbit)
    pieces: list[Piece] = []
    waiting = [(low, high, 0)]
    while waiting:
        first, last, depth = waiting.pop()
        half = (first + last) / 2
        try:
            # Newton's method starts from the previous piece, so that the piece must not be too wide.
            if last - first > LARGEST_PIECE:
                raise ProofError("a piece too wide")
            piece = _piece(arcs, pieces[-1].middle if pieces else [arb(value) for value in guess], first, last)
        except ProofError as error:
            if depth > MAX_HALVINGS:
                raise ProofError(f"a = {arb(half).str(8, radius=False)}: not proved: {error}") from None
            waiting += [(half, last, depth + 1), (first, half, depth + 1)]
            continue
        if pieces:
            _check_same_orbit(pieces[-1], piece, first)
        pieces.append(piece)
    return pieces


def _piece(arcs: Sequence[Arc], guess: Sequence[arb], first: fmpq, last: fmpq) -> Piece:
    """Return the proof for all a from first to last; raises ProofError if it fails."""
    system = equations(arcs)
    with arithmetic():
        a = ball_between(arb(first), arb(last))
        center = a.mid()
    middle = refine_guess(system, guess, [center])
    matrix, count = derivatives(system, [*middle, center]), range(len(middle))
    with arithmetic():
        moved = solve_linear(submatrix(matrix, count, count), submatrix(matrix, count, [len(middle)]))
        direction = [-moved[k, 0].mid() for k in count]

    def offset_equations(unknown: Sequence[Any]) -> Sequence[Any]:
        """Return the equations in the distance from the tangent of the family, which is small over the piece."""
        *distance, at = unknown
        return system([*_point_near_tangent(middle, direction, at - center, distance), at])

    nothing = [arb(0)] * len(middle)
    enclosure = enclose(offset_equations, nothing, trial_radii(offset_equations, nothing, [a]), [a])
    with arithmetic():
        inner, outer = (
            tuple(_point_near_tangent(middle, direction, a - center, distance))
            for distance in (enclosure.inner, enclosure.outer)
        )
    proved = ProvedOrbit(tuple(arcs), a, Enclosure(inner, outer))
    proved.check_arcs()
    if not proved.slope > 0:
        raise ProofError(f"not proved that the multiplier increases with a: its slope is {proved.slope}")
    if not abs(proved.symmetric_multiplier) < 1:
        raise ProofError(f"not proved that symmetric perturbations decay: {proved.symmetric_multiplier}")
    return Piece(proved, middle, direction, enclosure.outer)


def _point_near_tangent(
    middle: Sequence[arb], direction: Sequence[arb], step: Any, distance: Sequence[Any]
) -> list[Any]:
    """Return the unknowns at a step in a along the tangent, plus a distance from it."""
    return [value + rate * step + offset for value, rate, offset in zip(middle, direction, distance, strict=True)]


def _check_same_orbit(left: Piece, right: Piece, a: fmpq) -> None:
    """Prove that two pieces have the same orbit at the a where they touch; raises ProofError if that fails."""
    system = equations(right.orbit.arcs)
    with arithmetic():
        point = arb(a)
    middle = refine_guess(system, right.middle, [point.mid()])
    shared = enclose(system, middle, [BOX_RADIUS] * len(middle), [point])
    for piece in (left, right):
        piece.check_contains(shared, point)
