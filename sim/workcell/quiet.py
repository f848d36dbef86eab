"""Keeps the physics engine's chatter off the standard output, which belongs to the command line."""

import ctypes
import os
from collections.abc import Iterator
from contextlib import contextmanager

_STDOUT = 1


@contextmanager
def quiet_stdout() -> Iterator[None]:
    """Drop whatever native code prints meanwhile."""
    libc = ctypes.CDLL(None)
    libc.fflush(None)
    kept = os.dup(_STDOUT)
    sink = os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(sink, _STDOUT)
        yield
    finally:
        # What native code has buffered must not appear after all.
        libc.fflush(None)
        os.dup2(kept, _STDOUT)
        os.close(sink)
        os.close(kept)
