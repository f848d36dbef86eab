"""A part that somebody holds out, as a world's snapshot keeps it."""

from mend.documents.strict_model import StrictModel
from mend.tasks.scene import Name


class HandOverSnapshot(StrictModel):
    """Somebody holds a part out until the clock reads `until_s`."""

    object: Name
    until_s: float
