"""The collection of garbage, so that it never stops a service for long."""

import gc


def settle_garbage() -> None:
    """Leave out of every later collection what is there once a service has started.

    That is modules and what they hold, half a million objects that stay for good: looking through
    them took more than a tenth of a second, whenever a large tree had come or gone.
    """
    gc.collect()
    gc.freeze()
