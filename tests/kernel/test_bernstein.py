"""First roots and maxima of polynomials against exact rational arithmetic.

The methods are C methods: the same .py files run uncompiled, from a copy of the package without compiled modules.
"""

import shutil
import subprocess
import sys

import pytest

BEGIN = """
import random
from fractions import Fraction
import numpy as np
from burridge_knopoff.kernel.bernstein import SearchedPolynomial

def polynomial(coefficients):
    p = SearchedPolynomial(24)
    p.degree = len(coefficients) - 1
    for k, x in enumerate(coefficients):
        p.coefficient[k] = float(x)
    return p

def at(c, t):
    return sum(x * t ** k for k, x in enumerate(c))
"""

ROOTS = """
random.seed(7)
checked = 0
for trial in range(600):
    real = sorted(Fraction(random.randint(1, 2 ** 20), 2 ** 20) * random.choice([1, 1, 3])
                  for _ in range(random.randint(0, 4)))
    c = [Fraction(1)]
    for root in real:
        c = np.convolve(c, [-root, Fraction(1)])
    for _ in range(random.randint(0, 5)):
        centre = Fraction(random.randint(-2 ** 10, 2 ** 11), 2 ** 10)
        # Complex pairs as close to the axis as 1e-6: near touches that must not be taken for roots.
        height = Fraction(1, random.choice([1, 10, 1000, 10 ** 6]))
        c = np.convolve(c, [centre ** 2 + height ** 2, -2 * centre, Fraction(1)])
    scale = max(map(abs, c)) * (-1 if c[0] < 0 else 1)
    c = [x / scale for x in c]
    found = polynomial(c).first_root(1.0)
    exact = [Fraction(float(x)) for x in c]
    # Truth: the rational polynomial changes sign for the first time at the first root of odd multiplicity.
    expected = min((r for r in real if r <= 1 and real.count(r) % 2), default=None)
    missing = expected is None or expected > 1 - Fraction(1, 10 ** 6)
    slope = 1.0 if missing else abs(float(at([k * x for k, x in enumerate(exact)], expected) / expected))
    if slope < 1e-9:
        continue
    if found >= 0.0 if missing else 0.0 <= found < float(expected) - 1e-6:
        # Only a touch, or a dip below rounding, may be taken for a root where there is none.
        assert abs(at(exact, Fraction(found))) < 1e-15, (trial, found)
    elif not missing:
        checked += 1
        assert abs(found - float(expected)) < 1e-13 / slope + 1e-15, (trial, found, float(expected))
assert checked > 250, checked
"""

DIPS = """
# ((t - 0.371)^2 - depth) (1 + t): two roots 2 sqrt(depth) apart, or none for a negative depth.
for exponent in range(2, 14):
    for sign in (1, -1):
        depth = sign * 10.0 ** -exponent
        square = [0.371 ** 2 - depth, -2 * 0.371, 1.0]
        found = polynomial([square[0], square[1] + square[0], square[2] + square[1], square[2]]).first_root(1.0)
        if sign < 0:
            assert found == -1.0, (exponent, found)
        else:
            assert abs(found - (0.371 - depth ** 0.5)) < 1e-15 / depth ** 0.5 + 1e-15, (exponent, found)
# A root at the right end must not hide the one before it, nor one at the left end the one after it.
for c, length, expected in (([1.0, -3.0, 2.0], 1.0, 0.5), ([0.0, 1.0, -1.0], 2.0, 1.0)):
    assert abs(polynomial(c).first_root(length) - expected) < 1e-15, c
"""

MAXIMA = """
random.seed(3)
for trial in range(300):
    c = np.array([random.uniform(-1, 1) / (k + 1) for k in range(random.randint(1, 13))])
    p, length = polynomial(c), random.uniform(0.01, 2.0)
    greatest = np.polyval(c[::-1], np.linspace(0.0, length, 20001)).max()
    found = p.maximum(length, -1e300)
    rounding = 1e-15 * (1.0 + (np.abs(c) * length ** np.arange(len(c))).sum())
    assert greatest - rounding <= found <= greatest + 1e-6, (trial, found, greatest)
    assert p.maximum(length, 1e9) == 1e9
"""

SHIFT = """
c = [0.0, 0.0, 1.5, -2.0, 0.25]
p = polynomial(c)
p.shift(0.5)
for t in (0.0, 0.25, 1.0):
    assert p.value(t) == float(at([Fraction(x) for x in c], Fraction(t + 0.5)))
assert p.slope(0.0) == 2 * 1.5 * 0.5 - 3 * 2.0 * 0.25 + 4 * 0.25 * 0.125
p = polynomial(c)
assert p.deflate() == 2 and p.degree == 2 and list(p.coefficient[:3]) == [1.5, -2.0, 0.25]
"""


@pytest.fixture(scope="module")
def uncompiled(repository, tmp_path_factory):
    folder = tmp_path_factory.mktemp("uncompiled")
    compiled = shutil.ignore_patterns("*.so", "*.pyd", "__pycache__")
    shutil.copytree(repository / "src" / "burridge_knopoff", folder / "burridge_knopoff", ignore=compiled)
    # The kernel as a whole is refused uncompiled.
    (folder / "burridge_knopoff" / "kernel" / "__init__.py").write_text("")
    return folder


@pytest.mark.parametrize("code", [ROOTS, DIPS, MAXIMA, SHIFT], ids=["roots", "dips", "maxima", "shift"])
def test_polynomials(uncompiled, code):
    program = f"import sys; sys.path.insert(0, {str(uncompiled)!r})\n{BEGIN}{code}"
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
