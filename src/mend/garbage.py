"""The collection of garbage: seldom while a process begins, and never for long once it serves."""

import gc

_YOUNG = 50_000
"""So many objects more than there were before are looked through: loading Mend makes ten times as
many, all of which stay, and took a quarter longer with Python's own 700."""


def look_for_garbage_seldom() -> None:
    """Have a process that begins load its modules without looking for garbage over and over."""
    gc.set_threshold(_YOUNG)


def settle_garbage() -> None:
    """Leave out of every later collection what is there once a service has started.

    That is modules and what they hold, half a million objects that stay for good: looking through
    them took more than a tenth of a second, whenever a large tree had come or gone.
    """
    gc.collect()
    gc.freeze()
