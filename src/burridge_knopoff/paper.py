"""The setting of the paper that a study is held against."""

#: Its friction laws; a study may know more.
PAPER_LAWS = ("linearized", "nonlinear")

#: Its velocity v of the driver, and how long its runs are.
PAPER_V = 0.1
PAPER_TRANSIENT = 3000.0
PAPER_WINDOW = 7000.0
