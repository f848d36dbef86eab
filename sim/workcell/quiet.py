"""Keeps the physics engine's chatter off the terminal, which belongs to the command line."""

import ctypes
import os
from collections.abc import Iterator
from contextlib import contextmanager

_STREAMS = (1, 2)
"""Standard output and standard error."""


@contextmanager
def silenced() -> Iterator[None]:
    """Drop whatever native code prints meanwhile."""
    libc = ctypes.CDLL(None)
    libc.fflush(None)
    kept = [os.dup(stream) for stream in _STREAMS]
    sink = os.open(os.devnull, os.O_WRONLY)
    try:
        for stream in _STREAMS:
            os.dup2(sink, stream)
        yield
    finally:
        # What native code has buffered must not appear after all.
        libc.fflush(None)
        for stream, original in zip(_STREAMS, kept, strict=True):
            os.dup2(original, stream)
            os.close(original)
        os.close(sink)
