"""The recurrences of a law's operations, inline because a row of the series is short; the class is in `friction.py`."""

from burridge_knopoff.kernel.vector cimport Vectors, convolution, each_exp, each_log, each_power, splat, vec

cdef double ROUNDING
cdef double FOLLOWED
cdef double SPENT

cdef enum:
    LINEAR = 0
    MULTIPLY = 1
    RECIPROCAL = 2
    POWER = 3
    EXP = 4

cdef class Friction:
    cdef readonly int value
    cdef readonly int slope
    cdef readonly bint linear
    cdef readonly bint hyperbolic
    cdef readonly double scale
    cdef readonly double rate
    cdef readonly double steepest
    cdef readonly double at_rest
    cdef readonly bint exponential
    cdef readonly Py_ssize_t columns
    cdef readonly Py_ssize_t length
    cdef int[:, ::1] operation
    cdef double[:, ::1] constant
    cdef double[::1] reciprocal
    cdef Vectors register
    cdef Vectors inverse
    cdef Vectors slopes
    cdef double[::1] number

    cdef double at(self, double speed) noexcept nogil
    cdef double shorten(self, double t) noexcept nogil
    cdef bint _is_followed(self, double t) noexcept nogil
    cdef void start(self, Py_ssize_t column, vec speed) noexcept nogil
    cdef void extend(self, Py_ssize_t column, Py_ssize_t n, int first, int last) noexcept nogil
    cdef void complete(self, Py_ssize_t column, Py_ssize_t first, Py_ssize_t count) noexcept nogil

cdef inline vec product(const vec *p, const vec *q, Py_ssize_t n) noexcept nogil:
    """Return the sum of p_k q_(n-k) over k = 0 ... n."""
    if n == 0:
        return p[0] * q[0]
    return (convolution(p, q, n) + p[0] * q[n]) + p[n] * q[0]

cdef inline vec inner(const vec *p, const vec *q, Py_ssize_t n) noexcept nogil:
    """Return the sum of p_k q_(n-k) over k = 1 ... n - 1; what was computed last comes last."""
    if n < 3:
        return p[1] * q[1] if n == 2 else splat(0.0)
    return (convolution(p + 1, q + 1, n - 2) + p[n - 1] * q[1]) + p[1] * q[n - 1]

cdef inline vec square(const vec *p, Py_ssize_t n) noexcept nogil:
    """Return the sum of p_k p_(n-k) over k = 0 ... n."""
    cdef Py_ssize_t k
    cdef Py_ssize_t half = (n + 1) // 2
    cdef vec even = splat(0.0)
    cdef vec odd = even
    for k in range(0, half - 1, 2):
        even += p[k] * p[n - k]
        odd += p[k + 1] * p[n - k - 1]
    if half % 2:
        even += p[half - 1] * p[n - half + 1]
    even = 2.0 * (even + odd)
    if n % 2 == 0:
        even = even + p[half] * p[half]
    return even

cdef inline void squares(const vec *p, vec *out, Py_ssize_t first, Py_ssize_t count) noexcept nogil:
    """Fill coefficients first ... count - 1 of p², two at a time, which read the same coefficients of p."""
    cdef Py_ssize_t k
    cdef Py_ssize_t m
    cdef vec even
    cdef vec odd
    cdef vec factor
    cdef vec next_factor
    for m in range(first // 2, (count + 1) // 2):
        even = odd = splat(0.0)
        next_factor = p[2 * m + 1]
        for k in range(m):
            factor = p[2 * m - k]
            even += p[k] * factor
            odd += p[k] * next_factor
            next_factor = factor
        out[2 * m] = 2.0 * even + p[m] * p[m]
        if 2 * m + 1 < count:
            out[2 * m + 1] = 2.0 * (odd + p[m] * p[m + 1])

cdef inline vec weighted(const vec *p, const vec *q, Py_ssize_t n, double weight, double shift) noexcept nogil:
    """Return the sum of (weight k + shift) p_k q_(n-k) over k = 0 ... n."""
    cdef Py_ssize_t k
    cdef vec total = splat(0.0)
    for k in range(n + 1):
        total += (weight * k + shift) * (p[k] * q[n - k])
    return total

cdef inline vec *row(Friction law, int register, Py_ssize_t column) noexcept nogil:
    """Return the coefficients of a register, lowest power first."""
    return law.register.at + (register * law.columns + column) * law.length

cdef inline void fill(Friction law, Py_ssize_t column, Py_ssize_t n, int first, int last) noexcept nogil:
    """Fill coefficient n of the registers first + 1 ... last; those of lower order are there already."""
    cdef int r, code
    cdef double alpha
    cdef vec *p
    cdef vec *q
    cdef vec *out
    cdef vec *inverse
    cdef vec made
    for r in range(first, last):
        code = law.operation[r, 0]
        alpha = law.constant[r, 0]
        p = row(law, law.operation[r, 1], column)
        out = row(law, r + 1, column)
        if code == LINEAR:
            made = alpha * p[n]
            if law.operation[r, 2] >= 0:
                q = row(law, law.operation[r, 2], column)
                made = made + law.constant[r, 1] * q[n]
            if n == 0:
                made = made + law.constant[r, 2]
            out[n] = made
            continue
        if code == MULTIPLY:
            q = row(law, law.operation[r, 2], column)
            out[n] = square(p, n) if p == q else product(p, q, n)
            continue
        inverse = law.inverse.at + (r * law.columns + column)
        if n == 0:
            if code == RECIPROCAL:
                made = splat(1.0) / p[0]
            elif code == POWER:
                made = each_power(p[0], alpha)
            elif code == EXP:
                made = each_exp(p[0])
            else:
                made = each_log(p[0])
            if code != EXP:
                inverse[0] = splat(1.0) / p[0]
        elif code == RECIPROCAL:
            made = -((inner(p, out, n) + p[n] * out[0]) * out[0])
        elif code == POWER:
            # n p_0 y_n is the sum of ((alpha + 1) k - n) p_k y_(n-k) over k = 1 ... n.
            made = weighted(p + 1, out, n - 1, alpha + 1.0, alpha + 1.0 - n) * law.reciprocal[n] * inverse[0]
        elif code == EXP:
            # n y_n is the sum of k p_k y_(n-k) over k = 1 ... n.
            made = weighted(p + 1, out, n - 1, 1.0, 1.0) * law.reciprocal[n]
        else:
            # n p_0 y_n is n p_n minus the sum of (n - k) p_k y_(n-k) over k = 1 ... n - 1.
            made = p[n]
            if n > 1:
                made = made - weighted(p + 1, out + 1, n - 2, -1.0, n - 1.0) * law.reciprocal[n]
            made = made * inverse[0]
        out[n] = made

cdef inline vec *slopes(Friction law, Py_ssize_t column) noexcept nogil:
    """Return the derivatives of all registers by the speed at the start of the series."""
    return law.slopes.at + column * (law.value + 1)

cdef inline void prepare(Friction law, Py_ssize_t column, Py_ssize_t n) noexcept nogil:
    """Fill coefficient n of all registers but for what follows from that of the speed, which `settle` adds."""
    row(law, 0, column)[n] = splat(0.0)
    fill(law, column, n, 0, law.value)

cdef inline void settle(Friction law, Py_ssize_t column, Py_ssize_t n, vec speed) noexcept nogil:
    """Add to coefficient n of all registers what follows from that of the speed, which enters linearly."""
    cdef int r
    row(law, 0, column)[n] = speed
    for r in range(1, law.value + 1):
        row(law, r, column)[n] += slopes(law, column)[r] * speed
