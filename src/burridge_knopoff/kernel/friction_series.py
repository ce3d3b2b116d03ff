"""Taylor series of a friction law along the motion, in lanes: a law is a tape of operations on truncated series.

Register 0 is the speed u = |U'|; operation r reads earlier registers i, j and makes register r + 1:

    LINEAR      α r_i + β r_j + γ   (j = −1: no second)      POWER   r_i^α
    MULTIPLY    α r_i r_j                                    EXP     α exp(r_i)
    RECIPROCAL  α / r_i                                      LOG     α log(r_i)

Each coefficient follows from earlier ones by the product rule. Reference: A. Griewank and A. Walther, "Evaluating
Derivatives", 2nd ed., SIAM (2008), chapter 13.
"""

import cython
import numpy as np
from cython.cimports.burridge_knopoff.kernel.friction import FOLLOWED, SPENT
from cython.cimports.burridge_knopoff.kernel.vector import (
    Vectors,
    bits,
    convolution,
    each_exp,
    each_log,
    each_power,
    less,
    magnitude,
    mask,
    select,
    splat,
    vec,
)

LINEAR = 0
MULTIPLY = 1
RECIPROCAL = 2
POWER = 3
EXP = 4
LOG = 5


class FrictionSeries:
    """The series of Φ in `columns` columns of vectors, to the given order.

    Column c of register r has its coefficient k in register.at[(r·columns + c)·length + k]; Φ begins at `result`, with
    its column 0. Code that fills coefficients n of register 0 calls `begin` (n = 0) or `extend`. A law of only
    LINEAR operations is `affine`, Φ = constant + slope·u, and needs no series.

    code, first, second (int) and alpha, beta, gamma : the tape, one entry for each operation
    value : the register that is Φ
    """

    columns: cython.Py_ssize_t
    length: cython.Py_ssize_t
    operations: cython.Py_ssize_t
    affine: cython.bint
    exponential: cython.bint
    constant: cython.double
    slope: cython.double
    register: Vectors
    weighted: Vectors
    inverse: Vectors
    result: cython.Py_ssize_t
    code: cython.int[::1]
    first: cython.int[::1]
    second: cython.int[::1]
    alpha: cython.double[::1]
    beta: cython.double[::1]
    gamma: cython.double[::1]
    reciprocal: cython.double[::1]

    def __init__(
        self,
        columns: int,
        order: int,
        code: np.ndarray,
        first: np.ndarray,
        second: np.ndarray,
        alpha: np.ndarray,
        beta: np.ndarray,
        gamma: np.ndarray,
        value: int,
    ) -> None:
        self.columns = columns
        self.length = order + 1
        self.operations = len(code)
        self.code = np.array(code, dtype=np.intc)
        self.first = np.array(first, dtype=np.intc)
        self.second = np.array(second, dtype=np.intc)
        self.alpha = np.array(alpha, dtype=float)
        self.beta = np.array(beta, dtype=float)
        self.gamma = np.array(gamma, dtype=float)
        self.reciprocal = 1.0 / np.maximum(np.arange(order + 1, dtype=float), 1.0)
        self.affine = not np.any(np.asarray(self.code) != LINEAR)
        self.exponential = EXP in code
        self.constant = 0.0
        self.slope = 0.0
        if self.affine:
            lines = [(0.0, 1.0)]
            for i, j, a, b, c in zip(first, second, alpha, beta, gamma, strict=True):
                other = lines[j] if j >= 0 else (0.0, 0.0)
                lines.append((a * lines[i][0] + b * other[0] + c, a * lines[i][1] + b * other[1]))
            self.constant, self.slope = lines[value]
        size = 0 if self.affine else columns * self.length
        self.register = Vectors((self.operations + 1) * size)
        # k times the k-th coefficient of a register, for the operations whose recurrence has a derivative in it.
        self.weighted = Vectors(self.operations * size)
        self.inverse = Vectors(self.operations * columns)
        self.result = value * size

    def begin(self, column: cython.Py_ssize_t) -> None:
        """Fill coefficient 0 of one column of all registers from that of register 0."""
        r: cython.Py_ssize_t
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        out: cython.Py_ssize_t
        code: cython.int
        alpha: cython.double
        at: cython.pointer[vec] = self.register.at
        inverse: cython.pointer[vec] = self.inverse.at
        for r in range(self.operations):
            i = (self.first[r] * self.columns + column) * self.length
            j = (self.second[r] * self.columns + column) * self.length
            out = ((r + 1) * self.columns + column) * self.length
            code = self.code[r]
            alpha = self.alpha[r]
            if code == LINEAR:
                at[out] = alpha * at[i] + self.gamma[r]
                if self.second[r] >= 0:
                    at[out] = at[out] + self.beta[r] * at[j]
            elif code == MULTIPLY:
                at[out] = alpha * at[i] * at[j]
            elif code == EXP:
                at[out] = alpha * each_exp(at[i])
            else:
                inverse[r * self.columns + column] = splat(1.0) / at[i]
                if code == RECIPROCAL:
                    at[out] = alpha * inverse[r * self.columns + column]
                elif code == LOG:
                    at[out] = alpha * each_log(at[i])
                else:
                    at[out] = each_power(at[i], alpha)

    def extend(self, n: cython.Py_ssize_t) -> None:
        """Fill coefficient n ≥ 1 of all registers from that of register 0 and the coefficients before."""
        r: cython.Py_ssize_t
        for r in range(self.operations):
            if self.code[r] == LINEAR:
                self._add(r, n)
            elif self.code[r] == RECIPROCAL:
                self._divide(r, n)
            else:
                self._convolve(r, n)

    def shorten(self, t: vec) -> vec:
        """Return times, t or parts of them, over which every exponential is followed or spent, as in `friction`.

        All coefficients but the last have been filled.
        """
        r: cython.Py_ssize_t
        column: cython.Py_ssize_t
        k: cython.Py_ssize_t
        total: vec
        weighted: cython.pointer[vec]
        argument: vec
        limit: vec = splat(FOLLOWED * (self.length - 1))
        spent: vec
        far: mask
        for r in range(self.operations):
            if self.code[r] == EXP:
                for column in range(self.columns):
                    weighted = self.weighted.at + (r * self.columns + column) * self.length
                    argument = self.register.at[(self.first[r] * self.columns + column) * self.length]
                    spent = magnitude(argument) - splat(SPENT)
                    while True:
                        total = splat(0.0)
                        for k in range(self.length - 2, 0, -1):
                            total = (total + magnitude(weighted[k])) * t
                        far = less(limit, total) & less(spent, total)
                        if not bits(far):
                            break
                        t = select(far, splat(0.5) * t, t)
        return t

    def _add(self, r: cython.Py_ssize_t, n: cython.Py_ssize_t) -> None:
        """Extend α r_i + β r_j + γ."""
        _column: cython.Py_ssize_t
        at: cython.pointer[vec] = self.register.at
        i: cython.Py_ssize_t = self.first[r] * self.columns * self.length + n
        j: cython.Py_ssize_t = self.second[r] * self.columns * self.length + n
        out: cython.Py_ssize_t = (r + 1) * self.columns * self.length + n
        alpha: cython.double = self.alpha[r]
        for _column in range(self.columns):
            at[out] = alpha * at[i]
            if self.second[r] >= 0:
                at[out] = at[out] + self.beta[r] * at[j]
            i += self.length
            j += self.length
            out += self.length

    def _divide(self, r: cython.Py_ssize_t, n: cython.Py_ssize_t) -> None:
        """Extend α / r_i: the product of the two is α."""
        column: cython.Py_ssize_t
        at: cython.pointer[vec] = self.register.at
        i: cython.Py_ssize_t = self.first[r] * self.columns * self.length
        out: cython.Py_ssize_t = (r + 1) * self.columns * self.length
        for column in range(self.columns):
            at[out + n] = (
                -(convolution(at + i, at + out, n) + at[i + n] * at[out]) * self.inverse.at[r * self.columns + column]
            )
            i += self.length
            out += self.length

    def _convolve(self, r: cython.Py_ssize_t, n: cython.Py_ssize_t) -> None:
        """Extend any other operation."""
        column: cython.Py_ssize_t
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        out: cython.Py_ssize_t
        at: cython.pointer[vec] = self.register.at
        weighted: cython.pointer[vec]
        inverse: vec
        total: vec
        code: cython.int = self.code[r]
        alpha: cython.double = self.alpha[r]
        factor: cython.double = self.reciprocal[n]
        order: cython.double = n
        for column in range(self.columns):
            i = (self.first[r] * self.columns + column) * self.length
            j = (self.second[r] * self.columns + column) * self.length
            out = ((r + 1) * self.columns + column) * self.length
            weighted = self.weighted.at + (r * self.columns + column) * self.length
            inverse = self.inverse.at[r * self.columns + column]
            if code == MULTIPLY:
                total = convolution(at + i, at + j, n) + (at[i] * at[j + n] + at[i + n] * at[j])
                at[out + n] = alpha * total
            elif code == EXP:
                weighted[n] = order * at[i + n]
                total = convolution(weighted, at + out, n) + weighted[n] * at[out]
                at[out + n] = factor * total
            elif code == LOG:
                total = factor * convolution(weighted, at + i, n)
                at[out + n] = (alpha * at[i + n] - total) * inverse
                weighted[n] = order * at[out + n]
            else:
                # n r_0 out_n = Σ ((α + 1) k − n) r_k out_(n−k) over k = 1 … n.
                weighted[n] = order * at[i + n]
                total = (factor * (alpha + 1.0)) * (convolution(weighted, at + out, n) + weighted[n] * at[out])
                total = total - (convolution(at + i, at + out, n) + at[i + n] * at[out])
                at[out + n] = total * inverse
