"""What other robots hide from a camera, and whether it is worth waiting until they have passed."""

import numpy as np
from numpy.typing import NDArray

from mend.robots.body import CameraImage

_STANDS_STILL_S = 2.0
"""Who moves no more for so long may stay where it is: nobody waits for that."""
_SHRINKS = 0.97
"""What shrinks by less than to this share does not shrink."""


class BehindOthers:
    """What other robots have hidden in each of some pictures of a camera that stands still."""

    def __init__(self) -> None:
        self._hidden: NDArray[np.bool_] | None = None
        self._count = 0
        self._shrunk_s = 0.0

    def will_show(self, image: CameraImage, where: NDArray[np.bool_]) -> bool:
        """Whether what of `where` (h, w) was hidden up to this picture may soon be seen.

        So it is while robots move out of what they hid, which they do only so often.
        """
        if image.others is None:
            return False
        self._hidden = image.others if self._hidden is None else self._hidden & image.others
        count = int(np.count_nonzero(self._hidden))
        if self._count == 0 or count < _SHRINKS * self._count:
            self._count, self._shrunk_s = count, image.time
        moves = image.time - self._shrunk_s < _STANDS_STILL_S
        return moves and bool((self._hidden & where).any())
