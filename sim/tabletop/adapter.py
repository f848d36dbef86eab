"""The tabletop as a kind of world that runs can name (entry point `mend.worlds`)."""

from collections.abc import Iterable
from typing import ClassVar

from mend.robots.arm.body import Reach
from mend.sim.listed_world import ListedWorld
from mend.sim.tabletop.layout import lay_out
from mend.sim.tabletop.options import TabletopOptions
from mend.tasks.scene import Scene


class TabletopAdapter(ListedWorld):
    """Makes tabletop worlds; they never block for long."""

    name: ClassVar[str] = "tabletop"
    maker: ClassVar[tuple[str, str]] = ("mend.sim.tabletop.tabletops", "TABLETOPS")
    own_process = False
    lays_out_anything = True
    options = TabletopOptions

    def lay_out(self, names: Iterable[tuple[str, str | None]], seed: int) -> Scene:
        """Make up a scene for the (object, place) names of a tree.

        Raises `WrongInputError` for more than there is room and colours for.
        """
        return lay_out(names, seed)

    def reach(self, scene: Scene) -> Reach:
        """How far each robot reaches."""
        reach: Reach = self._made_by().reach(scene)
        return reach


adapter = TabletopAdapter()
