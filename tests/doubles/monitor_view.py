"""What a monitor is shown before the first step, when all is well."""

import numpy as np
from drawn_scene import PARTS, TABLE_Z

from mend.robots.arm.body import Reach
from mend.robots.arm.monitors.monitor import ArmView
from mend.robots.execution.phase import Phase
from mend.robots.vision.blob import Blob
from mend.robots.vision.head import HeadSighting

BLOB = Blob((50.0, 60.0), 200, (40, 50, 20, 20), np.zeros((120, 160), np.uint8))
SEEN = HeadSighting(0.5, -0.2, TABLE_Z, 0.0, TABLE_Z + 0.04, True, 1.0, BLOB, 0.0)
VIEW = ArmView(
    time_s=1.0,
    step=0,
    phase=Phase.PREPARE,
    part=PARTS["pink_bar"],
    needs_help=False,
    reach=Reach((0.0, 0.0), 0.3, 0.8),
    table_z=TABLE_Z,
    sighting=SEEN,
)
