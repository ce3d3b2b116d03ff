"""The compiled core: Cython in pure Python mode."""

from burridge_knopoff.provenance.kernel_build import check_kernel

check_kernel(compiled=True)
