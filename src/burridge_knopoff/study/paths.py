"""Where the point files of a study lie below its results."""

#: Of the points, below `points`; of those of another solver, below `solvers/<solver>`.
POINT = "{law}/{initial}/a{a}.nc"
