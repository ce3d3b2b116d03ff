"""The version of the package, which its files and `bk --version` say."""

__version__ = "0.1.0"
