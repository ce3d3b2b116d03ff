"""The setting of the paper that a study is held against."""

#: Its friction laws; a study may know more.
PAPER_LAWS = ("linearized", "nonlinear")

#: Its velocity v of the driver, and how long its runs are.
PAPER_V = 0.1
PAPER_TRANSIENT = 3000.0
PAPER_WINDOW = 7000.0

#: The friction parameter of its figures of single runs (Figs. 5, 6 and 7).
PAPER_A = 0.08

#: Where the basins are mapped if a study does not say: synchrony with and without rivals, and beyond its loss. Other
#: laws are mapped where the first of these is.
PAPER_BASINS = {"linearized": (0.05, 0.08, 0.15), "nonlinear": (0.08,)}

#: Where the solvers are compared if a study does not say: two synchronized values, the paper's figures, and chaos.
PAPER_COMPARED = (0.02, 0.05, 0.08, 0.2)

#: Where states are drawn by their phases if a study does not say: the paper's range of synchrony, and up to its loss.
PAPER_PHASES = (0.005, 0.01, 0.02, 0.03, 0.04, 0.05, 0.06, 0.07, 0.075, 0.08, 0.085, 0.09)
