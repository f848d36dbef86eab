"""How the kernels of the search are compiled."""

from collections.abc import Callable
from typing import Any, TypeVar, cast

import numba

Kernel = TypeVar("Kernel", bound=Callable[..., Any])


PLAIN = {"_nrt": False, "error_model": "numpy"}
"""No reference counting: the kernels allocate nothing, and counting the many arrays of a problem at
every call took thirty times as long as the kernels themselves."""


def compiled(function: Kernel) -> Kernel:
    """Compile on the first call, keeping the result where some cache folder can be written."""
    njit = cast(Any, numba.njit)
    try:
        return cast(Kernel, njit(cache=True, **PLAIN)(function))
    except RuntimeError:
        return cast(Kernel, njit(**PLAIN)(function))
