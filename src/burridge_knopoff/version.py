"""The version of the package, recorded in its files and printed by `bk --version`."""

__version__ = "0.1.0"
