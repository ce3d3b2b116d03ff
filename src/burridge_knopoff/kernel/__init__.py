"""The compiled core: Cython in pure Python mode, a .py file with the code and a .pxd file with the C declarations.

The .py file shows all types. They stand in the .pxd file too: where a class has one, Cython 3.3 refuses attributes that
are declared elsewhere ("C attributes cannot be added in implementation part of extension type defined in a pxd"), and
without one other modules cannot cimport the class. Where both files give a type, Cython compares those of arguments and
ignores those of attributes and results; tests/kernel/test_types.py holds all of them equal.
"""

from burridge_knopoff.provenance.kernel_build import check_kernel

# Where a wheel holds several modules, this is the widest that the processor runs.
__path__.insert(0, str(check_kernel(compiled=True)))
