"""Where the point files of a study lie in its results."""

#: Path of a point, in the folder `points`, or `solvers/<solver>` for another solver.
POINT = "{law}/{initial}/a{a}.nc"
