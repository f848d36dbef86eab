"""Memory for pictures: a process that looks keeps what it has had.

glibc gives blocks as large as pictures back to the system each time, and gets them anew, page by
page: more than half of the time that a look takes (mallopt(3)).
"""

import ctypes
from functools import cache

_TRIM_THRESHOLD, _MMAP_THRESHOLD = -1, -3
"""What the two settings are called in glibc's `malloc.h`."""
_LARGEST_BYTES = 32 * 2**20
"""The largest block that glibc can be told to keep."""
_KEPT_BYTES = 256 * 2**20


@cache
def keep_picture_memory() -> bool:
    """Keep up to 256 MB for the next pictures; False where the C library cannot be told so."""
    try:
        mallopt = ctypes.CDLL(None).mallopt
    except (AttributeError, OSError, TypeError):
        return False
    settings = ((_MMAP_THRESHOLD, _LARGEST_BYTES), (_TRIM_THRESHOLD, _KEPT_BYTES))
    return all(mallopt(setting, size_bytes) == 1 for setting, size_bytes in settings)
