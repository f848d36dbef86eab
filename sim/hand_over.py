"""A part that somebody holds out, as a world's snapshot keeps it."""

from mend.tasks.scene import Name, StrictModel


class HandOverSnapshot(StrictModel):
    """Somebody holds a part out until the clock reads `until_s`."""

    object: Name
    until_s: float
