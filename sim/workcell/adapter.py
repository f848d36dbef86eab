"""The workcell as a kind of world that runs can name (entry point `mend.worlds`)."""

from pathlib import Path
from typing import ClassVar

from mend.robots.arm.body import Reach
from mend.sim.listed_world import ListedWorld
from mend.sim.workcell.options import WorkcellOptions
from mend.sim.workcell.robot_model import MODEL, check_installed, robot_urdf
from mend.tasks.scene import Scene


class WorkcellAdapter(ListedWorld):
    """Makes workcells; PyBullet blocks its whole process and may crash it."""

    name: ClassVar[str] = "workcell"
    maker: ClassVar[tuple[str, str]] = ("mend.sim.workcell.workcells", "WORKCELLS")
    own_process = True
    lays_out_anything = False
    options = WorkcellOptions
    model = MODEL

    def reach(self, scene: Scene) -> Reach:
        """How far each robot reaches."""
        reach: Reach = self._made_by().reach(scene)
        return reach

    def model_folder(self) -> Path:
        """The trimmed PR2's files; made on the first call on a machine."""
        return robot_urdf().parent

    def check_available(self) -> None:
        """Raise `WorldUnavailableError` where PyBullet or the robot's description is missing."""
        super().check_available()
        check_installed()


adapter = WorkcellAdapter()
