"""What the journal keeps of a site, from which it is there again after a restart."""

from collections.abc import Mapping, Sequence
from datetime import datetime
from typing import Any, Literal, Self
from uuid import UUID

from pydantic import BaseModel, ConfigDict

from mend.server.journal import events as ev
from mend.server.sites.requests import FleetOptions
from mend.sim.world import WorldSetup
from mend.tasks.scenario import ScriptedIntervention
from mend.tasks.scene import Scatter, Scene

KIND = "site"
"""The kind of document that the journal keeps it as; its name is the site's id."""


class SiteRecord(BaseModel):
    """A site that is open. `scene` is as it was opened, `moved` which part is at which place now.

    `robots` are in the order of the scene's.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    site: UUID
    opened: datetime
    world: str
    scene: Scene
    robots: list[str]
    seed: int
    speed: float | Literal["max"]
    options: dict[str, Any]
    moved: dict[str, str] = {}
    author: ev.Author | None = None
    fleet: FleetOptions | None = None
    interventions: list[ScriptedIntervention] = []

    @property
    def scene_now(self) -> Scene:
        """The scene, with each part where a run has left it as far as its robots said."""
        at = {
            name: part.model_copy(update={"pose": self.scene.places[self.moved[name]].pose})
            for name, part in self.scene.objects.items()
            if self.moved.get(name) in self.scene.places
        }
        changed: dict[str, Any] = {"objects": {**self.scene.objects, **at}}
        if at:
            # That is for what still is where the world began; nobody has moved the rest by chance.
            changed["scatter"] = Scatter()
        return self.scene.model_copy(update=changed)

    def scene_for(self, robots: Sequence[str]) -> Scene:
        """That scene, with none but these of its robots, in its order."""
        named = zip(self.robots, self.scene.robots.items(), strict=False)
        standing = dict(base for robot, base in named if robot in robots)
        return self.scene_now.model_copy(update={"robots": standing})

    def after(self, moved: Mapping[str, str]) -> Self:
        """What is to be kept once a run has left these parts at these places."""
        return self.model_copy(update={"moved": {**self.moved, **moved}})

    def setup(self) -> WorldSetup:
        """What its world is told at its start."""
        return WorldSetup(
            robots=self.robots,
            scene=self.scene,
            seed=self.seed,
            speed=None if self.speed == "max" else self.speed,
            options=self.options,
            interventions=self.interventions,
        )
