"""A world that is listed where what it needs is not installed, and loaded once it is used."""

import importlib.util
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, ClassVar

from pydantic import BaseModel

from mend.sim.checked_scenes import checked_scene, made_by
from mend.sim.world import WorldSetup, WorldUnavailableError
from mend.tasks.definition import BehaviorNode, GoalNode
from mend.tasks.scene import Scene
from mend.tasks.scene_problem import SceneProblem

if TYPE_CHECKING:
    from mend.robots.agent import AgentGroup
    from mend.robots.vision.color_model import ColorModel


class ListedWorld:
    """A `WorldAdapter`, `SceneChecker` and `ColorTeacher` whose work another module does.

    `maker` is that module, and an object in it. What it imports is in the distribution's extra of
    the world's name: `needs` are the modules of that, and what each is called.
    """

    name: ClassVar[str]
    maker: ClassVar[tuple[str, str]]
    needs: ClassVar[dict[str, str]] = {"cv2": "OpenCV", "scipy": "SciPy", "numba": "Numba"}
    own_process: bool
    lays_out_anything: bool
    options: type[BaseModel]

    def check_available(self) -> None:
        """Raise `WorldUnavailableError` where something that it needs is not installed."""
        for module, called in self.needs.items():
            if importlib.util.find_spec(module) is None:
                raise WorldUnavailableError(
                    f"the {self.name} world needs {called}: "
                    f"install Mend as 'mend-robots[{self.name}]'"
                )

    def takes(self, scene: Scene) -> bool:
        """A scene with a setting is that of another kind of world."""
        return not scene.setting

    def create_agents(self, setup: WorldSetup) -> "AgentGroup":
        """Build the world and the robots in it.

        Raises `WorldUnavailableError`, `WrongInputError` for options and `ValueError` for a
        snapshot that do not fit.
        """
        agents: AgentGroup = self._made_by().create_agents(setup)
        return agents

    def check_scene(
        self, scene: Scene, nodes: Sequence[GoalNode | BehaviorNode]
    ) -> list[SceneProblem]:
        """What keeps all robots from doing the leaves among `nodes` in a scene."""
        self.check_available()
        return checked_scene(self.maker, scene, nodes)

    def train_colors(self, scene: Scene) -> "ColorModel":
        """Learn the colours of a scene's objects from rendered pictures of them.

        Raises `WrongInputError` for an object without a colour of its own.
        """
        model: ColorModel = self._made_by().train_colors(scene)
        return model

    def _made_by(self) -> Any:
        self.check_available()
        return made_by(self.maker)
