"""Checks of the files of a study: bad files, and files that do not belong to it."""
