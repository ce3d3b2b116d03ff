"""First roots and maxima of polynomials against exact rational arithmetic."""

import random
from fractions import Fraction

import numpy as np

from burridge_knopoff.kernel._core import first_root, maximum


def at(coefficients, t):
    return sum(x * t**k for k, x in enumerate(coefficients))


def test_first_roots():
    generator = random.Random(7)
    checked = 0
    for trial in range(600):
        roots = sorted(
            Fraction(generator.randint(1, 2**20), 2**20) * generator.choice([1, 1, 3])
            for _ in range(generator.randint(0, 4))
        )
        c = [Fraction(1)]
        for root in roots:
            c = np.convolve(c, [-root, Fraction(1)])
        for _ in range(generator.randint(0, 5)):
            centre = Fraction(generator.randint(-(2**10), 2**11), 2**10)
            # Complex pairs within 1e-6 of the axis are near touches that must not be taken for roots.
            height = Fraction(1, generator.choice([1, 10, 1000, 10**6]))
            c = np.convolve(c, [centre**2 + height**2, -2 * centre, Fraction(1)])
        scale = max(map(abs, c)) * (-1 if c[0] < 0 else 1)
        c = np.array([float(x / scale) for x in c])
        value = first_root(c, 1.0)
        exact = [Fraction(x) for x in c]
        # Truth: the rational polynomial changes sign for the first time at the first root of odd multiplicity.
        expected = min((r for r in roots if r <= 1 and roots.count(r) % 2), default=None)
        missing = expected is None or expected > 1 - Fraction(1, 10**6)
        slope = 1.0 if missing else abs(float(at([k * x for k, x in enumerate(exact)], expected) / expected))
        if slope < 1e-9:
            continue
        if value >= 0.0 if missing else 0.0 <= value < float(expected) - 1e-6:
            # Only a touch, or a dip below rounding, may be taken for a root where there is none.
            assert abs(at(exact, Fraction(value))) < 1e-15, (trial, value)
        elif not missing:
            checked += 1
            assert abs(value - float(expected)) < 1e-13 / slope + 1e-15, (trial, value, float(expected))
    assert checked > 250


def test_dips_of_any_depth():
    """((t − 0.371)² − depth)(1 + t): two roots 2 sqrt(depth) apart, or none for a negative depth."""
    for exponent in range(2, 14):
        for sign in (1, -1):
            depth = sign * 10.0**-exponent
            square = [0.371**2 - depth, -2 * 0.371, 1.0]
            root = first_root(np.convolve(square, [1.0, 1.0]), 1.0)
            if sign < 0:
                assert root == -1.0
            else:
                assert abs(root - (0.371 - depth**0.5)) < 1e-15 / depth**0.5 + 1e-15


def test_roots_at_the_ends():
    """One at the right end must not hide the one before it, nor one at the left end the one after it."""
    for c, length, expected in (([1.0, -3.0, 2.0], 1.0, 0.5), ([0.0, 1.0, -1.0], 2.0, 1.0)):
        assert abs(first_root(np.array(c), length) - expected) < 1e-15


def test_maxima():
    generator = random.Random(3)
    for trial in range(300):
        c = np.array([generator.uniform(-1, 1) / (k + 1) for k in range(generator.randint(1, 13))])
        length = generator.uniform(0.01, 2.0)
        greatest = np.polyval(c[::-1], np.linspace(0.0, length, 20001)).max()
        value = maximum(c, length, -1e300)
        rounding = 1e-15 * (1.0 + (np.abs(c) * length ** np.arange(len(c))).sum())
        assert greatest - rounding <= value <= greatest + 1e-6, (trial, value, greatest)
        assert maximum(c, length, 1e9) == 1e9
