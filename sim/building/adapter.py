"""The building as a kind of world that runs can name (entry point `mend.worlds`)."""

from collections.abc import Iterable
from typing import ClassVar

from mend.sim.building.options import BuildingOptions
from mend.sim.listed_world import ListedWorld
from mend.tasks.scene import Scene


class BuildingAdapter(ListedWorld):
    """Makes buildings with robots that drive in them."""

    name: ClassVar[str] = "building"
    maker: ClassVar[tuple[str, str]] = ("mend.sim.building.buildings", "BUILDINGS")
    own_process = False
    lays_out_anything = False
    options = BuildingOptions

    def lay_out(self, names: Iterable[tuple[str, str | None]], seed: int) -> Scene:  # noqa: ARG002
        """No building can be made up of names. Raises `ValueError`."""
        raise ValueError(
            "a building needs a scene that says what its floors are like: `mend building scene`"
        )

    def takes(self, scene: Scene) -> bool:
        """A building is a scene's setting."""
        return bool(scene.setting)


adapter = BuildingAdapter()
