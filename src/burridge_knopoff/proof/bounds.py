"""Bounds over whole arcs: proofs that a function of time is positive throughout the time between two events.

Evaluated on a ball of times, the motion gives a ball that contains all values of the function at these times; with
derivatives, the mean value theorem gives another bound. If neither proves the sign, the interval of time is halved. At
the ends of an arc a function may have a root that is known exactly. A block that starts has zero speed and
acceleration, so that the sign of the second derivative of its speed determines its motion just after. Where an arc
ends, one function passes through 0, and the sign of its first derivative determines its sign just before.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

from flint import arb, arb_series, fmpq

from burridge_knopoff.proof.balls import ProofError, arithmetic, ball_between, limits

#: A function of time that accepts power series.
Function = Callable[[Any], Any]

# Maximum number of halvings of an arc: down to a millionth of its length.
MAX_HALVINGS = 20

# Number of pieces of an arc for bounds that need not be sharp.
PIECES = 64


def jet(function: Function, time: arb) -> tuple[arb, arb, arb]:
    """Return balls that contain the values of a function and its first two derivatives at all times in a ball."""
    with arithmetic(3):
        value = arb_series(function(arb_series([time, 1])))
        return value[0], value[1], 2 * value[2]


def check_positive(function: Function, length: arb, root_at_start: bool = False, root_at_end: bool = False) -> None:
    """Prove that a function is positive at all times from 0 to the length of an arc, except at its known roots.

    length : a ball; the proof is for every length in it
    root_at_start : whether the function and its first derivative are exactly 0 at time 0
    root_at_end : whether the function is exactly 0 at the end, whichever length in the ball is the true one
    Raises ProofError with the time at which the proof failed, and if a root is not where it is assumed.
    """
    with arithmetic(3):
        roots = [
            *(jet(function, arb(0))[:2] if root_at_start else ()),
            *(jet(function, length)[:1] if root_at_end else ()),
        ]
        if not all(value.contains(0) for value in roots):
            raise ProofError(f"there is no root at its {'start' if root_at_start else 'end'} that could be excluded")
        last = length.upper()
        pieces = [(0, 0)]
        while pieces:
            depth, number = pieces.pop()
            low, high = (last * fmpq(number + side, 2**depth) for side in (0, 1))
            first, final = number == 0, number + 1 == 2**depth
            if not _is_positive(function, low, high, root_at_start and first, root_at_end and final):
                if depth == MAX_HALVINGS:
                    raise ProofError(f"at the time {float(low.mid())!r} of an arc: it may vanish there")
                pieces += [(depth + 1, 2 * number), (depth + 1, 2 * number + 1)]


def _is_positive(function: Function, low: arb, high: arb, root_at_start: bool, root_at_end: bool) -> bool:
    """Return whether a function is proved positive at all times from low to high, except for a root at one end."""
    time = ball_between(low, high)
    value, slope, curvature = jet(function, time)
    # The value itself or the mean value theorem may prove the sign.
    middle = jet(function, time.mid())[0]
    if value > 0 or middle + slope * (time - time.mid()) > 0:
        return True
    # By Taylor's formula f(t) = t² f''(ξ)/2 after a double root at 0; f(t) = (t − T) f'(ξ) before a root at T.
    return bool((root_at_start and curvature > 0) or (root_at_end and slope < 0))


def bounds(function: Function, length: arb) -> arb:
    """Return a ball that contains all values of a function from time 0 to the length of an arc."""
    values = [jet(function, piece)[0] for piece in _pieces(length)]
    with arithmetic():
        return ball_between(min(limits(value)[0] for value in values), max(limits(value)[1] for value in values))


def _pieces(length: arb) -> Iterator[arb]:
    with arithmetic():
        last = length.upper()
        for number in range(PIECES):
            yield ball_between(last * fmpq(number, PIECES), last * fmpq(number + 1, PIECES))
