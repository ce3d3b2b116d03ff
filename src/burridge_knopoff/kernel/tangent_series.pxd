from burridge_knopoff.kernel.piece cimport ORDER, Piece
from burridge_knopoff.kernel.springs cimport AFTER, BEFORE, DIAGONAL, Springs
from burridge_knopoff.kernel.state cimport State
from burridge_knopoff.kernel.tangent cimport Tangent
from burridge_knopoff.kernel.vector cimport Vectors, index, shuffle, splat, vec

# Degrees are odd, as coefficients are found two at a time.
cdef enum:
    LENGTH = (ORDER | 1) + 1

cdef double FALL
cdef double NEGLIGIBLE
cdef double SLOWER
cdef double STRIDE

cdef class TangentSeries:
    cdef Py_ssize_t vectors
    cdef Py_ssize_t columns
    cdef Py_ssize_t packs
    cdef Vectors positions
    cdef Vectors velocities
    cdef Vectors series
    cdef Vectors row
    cdef Vectors moving
    cdef Vectors weights
    cdef Vectors lookup
    cdef Vectors rates
    cdef Py_ssize_t rate_terms
    cdef Py_ssize_t degree
    cdef double[::1] reciprocal
    cdef double[::1] enough

    cdef Py_ssize_t load(self, State state, Piece piece, double length) noexcept nogil
    cdef void _expand_rates(self, State state, Py_ssize_t c, Py_ssize_t first, double t) noexcept nogil
    cdef bint _is_enough(self) noexcept nogil
    cdef void move_on(self) noexcept nogil
    cdef void follow(self, Springs springs, double t) noexcept nogil
    cdef void _follow(self, Springs springs, Py_ssize_t v, double t) noexcept nogil

cdef inline vec spread(TangentSeries tangent, vec blocks) noexcept nogil:
    """Return what a vector holds for the blocks in its lanes for each of the perturbations side by side."""
    return shuffle(blocks, blocks, (<const index *>tangent.lookup.at)[0])

cdef inline vec pull(vec before, vec after, vec own, index previous, index following) noexcept nogil:
    """Return the force of the neighbours on the blocks of a chain that lies in one vector."""
    return before * shuffle(own, own, previous) + after * shuffle(own, own, following)

cdef inline void follow_together(TangentSeries tangent, Py_ssize_t v, double t, int count) noexcept nogil:
    """Propagate `count` (at most 3) vectors of perturbations of a chain that lies in one vector: see `follow`.

    After the first row come two at a time, which read the same coefficients.
    """
    cdef Py_ssize_t n, j
    cdef int i
    cdef double factor
    cdef bint varying = tangent.rate_terms > 1
    cdef const vec *rate = tangent.rates.at
    cdef vec *u = tangent.series.at
    cdef vec diagonal = tangent.weights.at[DIAGONAL]
    cdef vec before = tangent.weights.at[BEFORE]
    cdef vec after = tangent.weights.at[AFTER]
    cdef index previous = (<const index *>tangent.lookup.at)[1]
    cdef index following = (<const index *>tangent.lookup.at)[2]
    cdef vec newest = rate[0]
    cdef vec weight
    cdef vec later
    cdef vec x[3]
    cdef vec old[3]
    cdef vec new[3]
    cdef vec now[3]
    cdef vec then[3]
    cdef vec position[3]
    cdef vec velocity[3]
    for i in range(count):
        position[i] = tangent.positions.at[v + i]
        velocity[i] = tangent.velocities.at[v + i]
        old[i] = velocity[i] * tangent.moving.at[0]
        u[i] = old[i]
        x[i] = old[i] * t
        new[i] = (splat(0.0) - diagonal * position[i]) + pull(before, after, position[i], previous, following)
        new[i] = new[i] + newest * old[i]
        position[i] = position[i] + x[i]
        velocity[i] = velocity[i] + new[i]
    for n in range(1, tangent.degree, 2):
        for i in range(count):
            u[count * n + i] = new[i]
            now[i] = then[i] = splat(0.0)
        if varying:
            later = rate[n + 1]
            for j in range(n - 1):
                weight = rate[n - j]
                for i in range(count):
                    now[i] = now[i] + weight * u[count * j + i]
                    then[i] = then[i] + later * u[count * j + i]
                later = weight
            for i in range(count):
                now[i] = now[i] + rate[1] * old[i]
                then[i] = (then[i] + rate[2] * old[i]) + rate[1] * new[i]
        factor = t * tangent.reciprocal[n + 1]
        for i in range(count):
            now[i] = (now[i] - diagonal * x[i]) + pull(before, after, x[i], previous, following)
            x[i] = new[i] * factor
            position[i] = position[i] + x[i]
            then[i] = (then[i] - diagonal * x[i]) + pull(before, after, x[i], previous, following)
        factor = tangent.reciprocal[n + 1]
        for i in range(count):
            old[i] = (now[i] + newest * new[i]) * factor
            u[count * (n + 1) + i] = old[i]
            velocity[i] = velocity[i] + old[i]
        factor = tangent.reciprocal[n + 2]
        for i in range(count):
            new[i] = (then[i] + newest * old[i]) * factor
            velocity[i] = velocity[i] + new[i]
            x[i] = old[i] * (t * factor)
            position[i] = position[i] + x[i]
    for i in range(count):
        tangent.positions.at[v + i] = position[i]
        tangent.velocities.at[v + i] = velocity[i]
