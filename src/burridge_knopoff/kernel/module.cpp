// What the kernel shows to Python.

#include <nanobind/nanobind.h>

namespace {

// Doubles in a vector of the processor that this file is compiled for.
int width() {
#if defined(__AVX512F__)
    return 8;
#elif defined(__AVX__)
    return 4;
#else
    return 2;
#endif
}

}  // namespace

NB_MODULE(_core, module) {
    module.def("width", &width, "Return the number of doubles in a vector.");
}
