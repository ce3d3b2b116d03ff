"""First roots and maxima of polynomials against exact rational arithmetic (uncompiled: the methods are C methods)."""

from tests.kernel.pure import run_uncompiled

ROOTS = """
import random
from fractions import Fraction
from burridge_knopoff.kernel.bernstein import SearchedPolynomial as Polynomial

def product(roots):
    c = [Fraction(1)]
    for root in roots:
        c = [(c[k - 1] if k else 0) - root * (c[k] if k < len(c) else 0) for k in range(len(c) + 1)]
    return c

def at(c, t):
    return sum(x * t ** k for k, x in enumerate(c))

random.seed(7)
checked = touches = missed = 0
for trial in range(600):
    real = sorted(Fraction(random.randint(1, 2 ** 20), 2 ** 20) * random.choice([1, 1, 3])
                  for _ in range(random.randint(0, 4)))
    c = product(real)
    for _ in range(random.randint(0, 5)):
        centre = Fraction(random.randint(-2 ** 10, 2 ** 11), 2 ** 10)
        # Complex pairs as close to the axis as 1e-6: near touches that must not be taken for roots.
        height = Fraction(1, random.choice([1, 10, 1000, 10 ** 6]))
        pair = [centre ** 2 + height ** 2, -2 * centre, Fraction(1)]
        c = [sum(c[i] * pair[k - i] for i in range(len(c)) if 0 <= k - i < 3) for k in range(len(c) + 2)]
    if at(c, Fraction(0)) < 0:
        c = [-x for x in c]
    scale = max(map(abs, c))
    c = [x / scale for x in c]
    p = Polynomial(24)
    p.degree = len(c) - 1
    for k, x in enumerate(c):
        p.coefficient[k] = float(x)
    exact = [Fraction(float(x)) for x in c]
    found = p.first_root(1.0)
    # Truth: the rational polynomial changes sign for the first time at the first root of odd multiplicity.
    inside = [r for r in real if r <= 1 and real.count(r) % 2]
    expected = min(inside, default=None)
    if expected is None or expected > 1 - Fraction(1, 10 ** 6):
        if found >= 0.0:
            # Only a dip below rounding may be called a root.
            assert abs(at(exact, Fraction(found))) < 1e-15, (trial, found)
            touches += 1
        continue
    slope = abs(float(sum(k * x * expected ** (k - 1) for k, x in enumerate(exact) if k)))
    if slope < 1e-9:
        continue
    if 0.0 <= found < float(expected) - 1e-6:
        # Before it, only a touch may be taken for a root, where rounding of the coefficients decides.
        assert abs(at(exact, Fraction(found))) < 1e-15, (trial, found)
        touches += 1
        continue
    checked += 1
    assert abs(found - float(expected)) < 1e-13 / slope + 1e-15, (trial, found, float(expected))
print(checked, touches)
assert checked > 250
"""

DIPS = """
from burridge_knopoff.kernel.bernstein import SearchedPolynomial as Polynomial
# ((t - 0.371)^2 - depth) (1 + t): two roots 2 sqrt(depth) apart, or none for a negative depth.
for exponent in range(2, 14):
    for sign in (1, -1):
        depth = sign * 10.0 ** -exponent
        p = Polynomial(24)
        p.degree = 3
        square = [0.371 ** 2 - depth, -2 * 0.371, 1.0]
        for k, x in enumerate([square[0], square[1] + square[0], square[2] + square[1], square[2]]):
            p.coefficient[k] = x
        found = p.first_root(1.0)
        if sign < 0:
            assert found == -1.0, (exponent, found)
        else:
            assert abs(found - (0.371 - depth ** 0.5)) < 1e-15 / depth ** 0.5 + 1e-15, (exponent, found)
# A root at the right end must not hide the one before it, nor one at the left end the one after it.
for c, length, expected in (([1.0, -3.0, 2.0], 1.0, 0.5), ([0.0, 1.0, -1.0], 2.0, 1.0)):
    p = Polynomial(24)
    p.degree = 2
    for k, x in enumerate(c):
        p.coefficient[k] = x
    assert abs(p.first_root(length) - expected) < 1e-15, c
print("ok")
"""

MAXIMA = """
import random
import numpy as np
from burridge_knopoff.kernel.bernstein import SearchedPolynomial as Polynomial
random.seed(3)
for trial in range(300):
    p = Polynomial(24)
    p.degree = random.randint(0, 12)
    for k in range(p.degree + 1):
        p.coefficient[k] = random.uniform(-1, 1) / (k + 1)
    length = random.uniform(0.01, 2.0)
    times = np.linspace(0.0, length, 20001)
    values = np.polyval(p.coefficient[p.degree :: -1], times)
    found = p.maximum(length, -1e300)
    terms = np.abs(p.coefficient[: p.degree + 1]) * length ** np.arange(p.degree + 1)
    rounding = 1e-15 * (1.0 + terms.sum())
    assert values.max() - rounding <= found <= values.max() + 1e-6, (trial, found, values.max())
    assert p.maximum(length, 1e9) == 1e9
print("ok")
"""

SHIFT = """
from fractions import Fraction
from burridge_knopoff.kernel.bernstein import SearchedPolynomial as Polynomial
p = Polynomial(8)
p.degree = 4
c = [0.0, 0.0, 1.5, -2.0, 0.25]
for k, x in enumerate(c):
    p.coefficient[k] = x
p.shift(0.5)
for t in (0.0, 0.25, 1.0):
    assert p.value(t) == float(sum(Fraction(x) * Fraction(t + 0.5) ** k for k, x in enumerate(c)))
assert p.slope(0.0) == 2 * 1.5 * 0.5 - 3 * 2.0 * 0.25 + 4 * 0.25 * 0.125
for k, x in enumerate(c):
    p.coefficient[k] = x
assert p.deflate() == 2 and p.degree == 2 and list(p.coefficient[:3]) == [1.5, -2.0, 0.25]
print("ok")
"""


def test_first_root_against_rational_arithmetic(tmp_path):
    checked, _ = map(int, run_uncompiled(tmp_path, ROOTS).split())
    assert checked > 250


def test_dips_of_any_depth_are_found(tmp_path):
    assert run_uncompiled(tmp_path, DIPS) == "ok\n"


def test_maximum_against_dense_sampling(tmp_path):
    assert run_uncompiled(tmp_path, MAXIMA) == "ok\n"


def test_shift_and_deflation(tmp_path):
    assert run_uncompiled(tmp_path, SHIFT) == "ok\n"
