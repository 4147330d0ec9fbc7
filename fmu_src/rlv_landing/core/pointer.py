"""How the kernels pass arrays to each other; compiled, as addresses (see `core_source`), which spares copies of buffers' descriptions."""

from contextlib import nullcontext

# In the compiled core, other threads run inside `with nogil`.
nogil = nullcontext()


def data(numbers):
    """The numbers of an array or buffer of doubles."""
    return numbers
