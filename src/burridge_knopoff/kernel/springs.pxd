from burridge_knopoff.kernel.vector cimport Vectors, index, shuffle, vec

# Rows of `lanes`.
cdef enum:
    DIAGONAL = 0
    BEFORE = 1
    AFTER = 2
    THRESHOLD = 3
    SLIDING = 4

cdef class Springs:
    cdef readonly Py_ssize_t blocks
    cdef readonly Py_ssize_t columns
    cdef double[::1] diagonal
    cdef double[::1] before
    cdef double[::1] after
    cdef double[::1] threshold
    cdef double[::1] sliding_force
    cdef Py_ssize_t[::1] previous
    cdef Py_ssize_t[::1] next
    cdef readonly double fastest
    cdef Vectors lanes
    cdef Vectors from_previous
    cdef Vectors from_next

    cdef double pull(self, const double* displacement, Py_ssize_t i) noexcept nogil

cdef inline vec pulls(Springs springs, const vec *displacement, Py_ssize_t column) noexcept nogil:
    """Return -(K x)_i for the blocks in the lanes of one column; `displacement` has all columns."""
    cdef Py_ssize_t columns = springs.columns
    cdef Py_ssize_t before = column - 1 if column > 0 else columns - 1
    cdef Py_ssize_t behind = column + 1 if column < columns - 1 else 0
    cdef vec own = displacement[column]
    cdef const vec *lanes = springs.lanes.at + column
    return (
        lanes[BEFORE * columns] * shuffle(displacement[before], own, (<const index *>springs.from_previous.at)[column])
        + lanes[AFTER * columns] * shuffle(own, displacement[behind], (<const index *>springs.from_next.at)[column])
    ) - lanes[DIAGONAL * columns] * own

cdef inline vec neighbours(
    Springs springs, const vec *before, const vec *after, const vec *displacement, Py_ssize_t column
) noexcept nogil:
    """Return the force of the neighbours on the blocks in the lanes of one column, by springs of other strengths."""
    cdef Py_ssize_t previous = column - 1 if column > 0 else springs.columns - 1
    cdef Py_ssize_t behind = column + 1 if column < springs.columns - 1 else 0
    cdef vec own = displacement[column]
    return (
        before[column] * shuffle(displacement[previous], own, (<const index *>springs.from_previous.at)[column])
        + after[column] * shuffle(own, displacement[behind], (<const index *>springs.from_next.at)[column])
    )

cdef inline vec thresholds(Springs springs, Py_ssize_t column) noexcept nogil:
    """Return the static friction of the blocks in the lanes of one column."""
    return springs.lanes.at[THRESHOLD * springs.columns + column]
