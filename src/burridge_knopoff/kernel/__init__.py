"""The compiled core: Cython in pure Python mode; the same files run uncompiled."""
