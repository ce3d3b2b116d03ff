"""The functions for users in Python, which accept models or names, plain numbers, and settings by name."""
