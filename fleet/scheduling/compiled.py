"""How the kernels of the search are compiled."""

from collections.abc import Callable
from typing import Any, TypeVar

import mend.maps.compiled

Kernel = TypeVar("Kernel", bound=Callable[..., Any])


PLAIN = {"_nrt": False, "error_model": "numpy", "no_cfunc_wrapper": True}
"""No reference counting: the kernels allocate nothing, and counting the many arrays of a problem at
every call took thirty times as long as the kernels themselves. No way in from C."""


def compiled(function: Kernel) -> Kernel:
    """Compile on the first call, keeping the result where some cache folder can be written.

    What is private can be called by other kernels alone: a way in from Python, through the many
    arrays of a problem, takes longer to compile than most kernels.
    """
    private = function.__name__.startswith("_")
    return mend.maps.compiled.compiled(function, **PLAIN, no_cpython_wrapper=private)


def inlined(function: Kernel) -> Kernel:
    """Compile into every caller: for what is called so often that passing the arrays of a problem
    would take longer than the rest."""
    return mend.maps.compiled.compiled(function, **PLAIN, no_cpython_wrapper=True, forceinline=True)
