"""How numeric kernels are compiled."""

from collections.abc import Callable
from contextlib import suppress
from typing import Any, TypeVar, cast

import numba

# Numba would import these with the first call of any kernel, and so change a table of types that a
# first call in another thread may be going through: "dictionary changed size during iteration".
import numba.core.ccallback
import numba.experimental.function_type

from mend.maps.kernel_cache import KernelCache

Kernel = TypeVar("Kernel", bound=Callable[..., Any])


def compiled(function: Kernel, **options: Any) -> Kernel:
    """Compile on the first call, keeping the result where some cache folder can be written.

    Without one (a read-only install and no home folder) numba refuses to keep anything. `options`
    of numba's own; a division by zero gives what NumPy gives unless they say otherwise.
    """
    options = {"error_model": "numpy", **options}
    kernel = cast(Any, numba.njit)(**options)(function)
    with suppress(RuntimeError, OSError):
        kernel._cache = KernelCache(function)
    return cast(Kernel, kernel)
