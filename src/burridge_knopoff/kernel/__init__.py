"""The compiled core, in C++: all of it is one module, `_core`, with its types in _core.pyi."""

from burridge_knopoff.provenance.kernel_build import check_kernel

# Where a wheel holds several modules, this is the widest that the processor runs.
__path__.insert(0, str(check_kernel(compiled=True)))
