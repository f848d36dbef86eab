"""How the kernels of the search are compiled."""

from collections.abc import Callable
from typing import Any, TypeVar, cast

import numba

Kernel = TypeVar("Kernel", bound=Callable[..., Any])


def compiled(function: Kernel) -> Kernel:
    """Compile on the first call, keeping the result where some cache folder can be written."""
    try:
        return cast(Kernel, numba.njit(cache=True, _nrt=False)(function))
    except RuntimeError:
        return cast(Kernel, numba.njit(_nrt=False)(function))
