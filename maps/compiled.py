"""How numeric kernels are compiled that may make arrays of their own."""

from collections.abc import Callable
from typing import Any, TypeVar, cast

import numba

Kernel = TypeVar("Kernel", bound=Callable[..., Any])


def compiled(function: Kernel) -> Kernel:
    """Compile on the first call, keeping the result where some cache folder can be written."""
    njit = cast(Any, numba.njit)
    try:
        return cast(Kernel, njit(cache=True, error_model="numpy")(function))
    except RuntimeError:
        return cast(Kernel, njit(error_model="numpy")(function))
