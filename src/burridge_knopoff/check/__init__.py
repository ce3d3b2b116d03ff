"""Checks of the files of a study: wrong files, and files that do not belong to it."""
