"""The parameters of the paper, from which defaults are taken."""

#: The friction laws of the paper.
PAPER_LAWS = ("linearized", "nonlinear")

#: The durations of the runs.
PAPER_TRANSIENT = 3000.0
PAPER_WINDOW = 7000.0

#: The friction parameter of the figures of single runs (Figs. 5, 6 and 7).
PAPER_A = 0.08

#: Default values of a for basin maps: synchrony with and without coexisting attractors, and a value beyond the loss of
#: synchrony. Other laws use the values of the first.
PAPER_BASINS = {"linearized": (0.05, 0.08, 0.15), "nonlinear": (0.08,)}

#: Default values of a for the comparison of solvers: two with synchrony, that of the paper's figures, and one in chaos.
PAPER_COMPARED = (0.02, 0.05, 0.08, 0.2)

#: Default values of a for states defined by phases: the paper's range of synchrony, up to its loss.
PAPER_PHASES = (0.005, 0.01, 0.02, 0.03, 0.04, 0.05, 0.06, 0.07, 0.075, 0.08, 0.085, 0.09)
