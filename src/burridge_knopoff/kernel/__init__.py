"""The compiled core: Cython in pure Python mode; the same files run uncompiled."""

from burridge_knopoff.kernel_build import check_kernel

check_kernel()
