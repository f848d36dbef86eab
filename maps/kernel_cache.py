"""Where compiled kernels are kept: until something that is compiled into them changes.

Numba keeps a kernel until its own file changes. But what it calls, and constants, are compiled into
it as well, from whatever file they come.
"""

import hashlib
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
from numba.core.caching import FunctionCache, IndexDataCacheFile
from numba.core.dispatcher import Dispatcher

_CONSTANTS = (bool, int, float, complex, str, bytes, tuple, np.dtype, np.generic)
_OURS = "mend"
_stamps: dict[Callable[..., Any], str] = {}


class KernelCache(FunctionCache):
    """Numba's cache of one kernel, which is of no use where anything it is made of is other."""

    def __init__(self, kernel: Callable[..., Any]) -> None:
        super().__init__(kernel)  # type: ignore[no-untyped-call]
        self._cache_file = IndexDataCacheFile(  # type: ignore[no-untyped-call]
            cache_path=self._cache_path,
            filename_base=self._impl.filename_base,
            source_stamp=stamp_of(kernel),
        )


def stamp_of(kernel: Callable[..., Any]) -> str:
    """A digest of a kernel's file, of all that this has imported so far, and of its constants."""
    if kernel not in _stamps:
        known = {k: v for k, v in kernel.__globals__.items() if not k.startswith("__")}
        parts = [_file(kernel.__code__.co_filename)]
        parts += [f"{name} {_part(value)}" for name, value in sorted(known.items())]
        _stamps[kernel] = hashlib.sha256("\n".join(parts).encode()).hexdigest()
    return _stamps[kernel]


def _part(value: object) -> str:
    """What a name stands for, as far as a kernel could have it compiled in."""
    if isinstance(value, Dispatcher):
        return _stamps.get(value.py_func) or _file(value.py_func.__code__.co_filename)
    if isinstance(value, np.ndarray):
        return hashlib.sha256(value.tobytes()).hexdigest()
    if isinstance(value, _CONSTANTS):
        return repr(value)
    name = value.__name__ if isinstance(value, ModuleType) else getattr(value, "__module__", None)
    module = sys.modules.get(name or "")
    ours = module is not None and module.__name__.split(".")[0] == _OURS
    return _file(module.__file__) if ours and module is not None and module.__file__ else ""


@cache
def _file(path: str) -> str:
    return hashlib.sha256(Path(path).read_bytes()).hexdigest()
