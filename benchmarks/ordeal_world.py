"""Buildings whose truth is written down as it happens, for those who judge what a fleet says.

Two kinds of world that a service may have besides its own: `witnessed` runs in the service's
process, as buildings do, and `witnessed_apart` in one of its own, which may be killed by itself.
What is written goes to the file that `ORDEAL_TRUTH` names, a line of JSON each, over all lives of
the world; a world that was killed begins anew where the journal has it, with a line that says so.
"""

import json
import math
import os
import time
from collections.abc import Callable, Iterator
from itertools import combinations
from pathlib import Path
from random import Random
from typing import Annotated, Any, ClassVar

from ordeal_kills import Executioner, Moment
from pydantic import Field

from mend.sim.building.adapter import BuildingAdapter
from mend.sim.building.buildings import BUILDINGS
from mend.sim.building.bystander import RADIUS_M as PERSON_RADIUS_M
from mend.sim.building.floor_pose import FloorPose
from mend.sim.building.options import BuildingOptions
from mend.sim.building.world import BuildingWorld
from mend.sim.shared_world import SharedWorld
from mend.sim.world import WorldSetup
from mend.tasks.intervention import Act, Intervention

TRUTH = "ORDEAL_TRUTH"
CALM = ".calm"
"""Once a file of the truth's name with this behind it is there, nobody lies any more."""
STATE_EVERY_S = 0.5
TOUCHES_M = 0.001
PROMISED = (Act.RELEASE, Act.PUT_IN, Act.TAKE_OUT, Act.SEND_PERSON, Act.CHARGE)


class WitnessedOptions(BuildingOptions):
    """`lies`: how often somebody who has said that they do something does not do it.

    `steals_every_s`: about so often somebody takes a thing out of a basket; 0 is never.
    """

    lies: Annotated[float, Field(ge=0.0, le=1.0, strict=False)] = 0.0
    steals_every_s: Annotated[float, Field(ge=0.0, strict=False)] = 0.0


class WitnessedBuilding(BuildingAdapter):
    """A `WorldAdapter` like that of buildings, with a witness in each."""

    options: ClassVar[type[BuildingOptions]] = WitnessedOptions

    def __init__(self, *, own_process: bool) -> None:
        self.own_process = own_process  # type: ignore[misc]

    def create_agents(self, setup: WorldSetup) -> SharedWorld:
        options = dict(setup.options)
        lies = float(options.pop("lies", 0.0))
        steals_every_s = float(options.pop("steals_every_s", 0.0))
        group = BUILDINGS.create_agents(setup.model_copy(update={"options": options}))
        assert isinstance(group.world, BuildingWorld)
        apart = self.own_process
        Witness(group.world, lies, steals_every_s, setup.seed, Path(os.environ[TRUTH]), apart=apart)
        return group


within, apart = WitnessedBuilding(own_process=False), WitnessedBuilding(own_process=True)


class Witness:
    """Writes down whatever happens in a world, has people lie and steal in it, and kills it."""

    def __init__(
        self,
        world: BuildingWorld,
        lies: float,
        steals_every_s: float,
        seed: int,
        file: Path,
        *,
        apart: bool,
    ) -> None:
        """`apart`: it has a process of its own."""
        self._world, self._lies, self._calm = world, lies, file.with_name(file.name + CALM)
        self._steals = STATE_EVERY_S / steals_every_s if steals_every_s else 0.0
        self._file = os.open(file, os.O_WRONLY | os.O_APPEND | os.O_CREAT)
        self._chance = Random(f"{seed} {world.time_s()}")
        self._executioner = Executioner(file, self._write, apart=apart)
        self._items: dict[str, list[Any]] = {}
        self._changed_hands = False
        self._touching: set[str] = set()
        self._bumps, self._carried, self._shows_s = world.touches, world.carried, 0.0
        self._pass_cycle, self._do = world.advance_cycle, world.intervene
        self._begun = False
        world.advance_cycle = self._cycle  # type: ignore[method-assign]
        world.intervene = self._intervene  # type: ignore[method-assign]

    def _begin(self) -> None:
        """The first that happens in this life: it was restored, or is new."""
        if not self._begun:
            self._begun, self._items = True, self._items_now()
            self._write("begun", items=self._items)

    def _cycle(self) -> None:
        self._begin()
        self._pass_cycle()
        world = self._world
        self._note_items()
        if world.touches > self._bumps:
            self._write("drove against something", times=world.touches - self._bumps)
            self._bumps = world.touches
        if world.carried > self._carried:
            self._write("carried")
            self._carried = world.carried
        touching = dict(self._touches())
        for who in touching.keys() - self._touching:
            self._write("touched", who=who, by_m=touching[who])
        self._touching = set(touching)
        if world.time_s() >= self._shows_s:
            self._shows_s = world.time_s() + STATE_EVERY_S
            self._note_state()
            if self._chance.random() < self._steals and not self._calm.exists():
                self._steal()
        self._look_for_kills()

    def _look_for_kills(self) -> None:
        changed_hands, self._changed_hands = self._changed_hands, False
        charges = any(each.charging and each.share < 1.0 for each in self._world.batteries)
        so = {Moment.CHANGES_HANDS: changed_hands, Moment.CHARGES: charges}
        self._executioner.look(self._world.time_s(), {each for each, is_so in so.items() if is_so})

    def _steal(self) -> None:
        """Somebody takes a thing out of a basket, if there is any in one."""
        goods = self._world.goods
        aboard = [n for n, each in goods.items.items() if each.robot is not None and not each.taken]
        if not aboard:
            return
        self._have_stolen(self._chance.choice(aboard), goods.steal)

    def _have_stolen(self, name: str | None, steal: Callable[[str], str]) -> str:
        """Write down whose basket somebody takes a thing out of, if they do; why they cannot."""
        goods = self._world.goods
        item = None if name is None else goods.items.get(name)
        robot = None if item is None else item.robot
        wish = None if robot is None else goods.wishes.get(robot)
        problem = steal(name or "")
        if not problem:
            self._note_items()
            offers = wish.item if wish is not None and wish.hands_over else None
            self._write("stolen", item=name, robot=robot, offers=offers)
        return problem

    def _intervene(self, intervention: Intervention) -> str:
        self._begin()
        lied = intervention.act in PROMISED and self._chance.random() < self._lies
        lied = lied and not self._calm.exists()
        if lied:
            problem = "somebody said so and did not do it"
        elif intervention.act is Act.STEAL:
            problem = self._have_stolen(intervention.object, lambda _: self._do(intervention))
        else:
            problem = self._do(intervention)
        self._note_items()
        self._write("did", act=str(intervention.act), problem=problem, lied=lied)
        self._look_for_kills()
        return problem

    def _items_now(self) -> dict[str, list[Any]]:
        return {
            name: [each.place, each.robot, each.taken, each.delivered, round(each.weight_kg, 3)]
            for name, each in self._world.goods.items.items()
        }

    def _note_items(self) -> None:
        now = self._items_now()
        if now != self._items:
            self._items, self._changed_hands = now, True
            self._write("items", items=now)

    def _note_state(self) -> None:
        world = self._world
        self._write(
            "state",
            robots=[[e.at.floor, round(e.at.x, 3), round(e.at.y, 3)] for e in world.robots],
            shut=[name for name, each in world.doors.items() if each.is_shut],
            guests={
                number: [each.person, each.at.floor, round(each.at.x, 3), round(each.at.y, 3)]
                for number, each in world.guests.there.items()
            },
        )

    def _touches(self) -> Iterator[tuple[str, float]]:
        """Whoever is where a robot is, and by how much."""
        robots = [
            (f"robot {n}", each.at, each.radius_m) for n, each in enumerate(self._world.robots)
        ]
        people = list(self._people())
        for a, b in [*combinations(robots, 2), *((a, b) for a in robots for b in people)]:
            apart_m = math.hypot(a[1].x - b[1].x, a[1].y - b[1].y) - a[2] - b[2]
            if a[1].floor == b[1].floor and apart_m < -TOUCHES_M:
                yield f"{a[0]} and {b[0]} at {a[1].floor} {a[1].x:.2f} {a[1].y:.2f}"[:80], -apart_m

    def _people(self) -> Iterator[tuple[str, FloorPose, float]]:
        world = self._world
        for n, bystander in enumerate(world.bystanders):
            yield f"bystander {n}", bystander.at, PERSON_RADIUS_M
        for n, walker in enumerate(world.walkers.people):
            yield f"walker {n}", walker.at, PERSON_RADIUS_M
        for n, guest in world.guests.there.items():
            yield f"guest of robot {n}", guest.at, PERSON_RADIUS_M

    def _write(self, what: str, **more: Any) -> None:
        when = {"t": round(self._world.time_s(), 3), "wall_s": round(time.time(), 3)}
        line = json.dumps({**when, "what": what, **more})
        os.write(self._file, line.encode() + b"\n")


def install(folder: Path) -> None:
    """Make the folder, once it is on the path, provide these worlds."""
    metadata = folder / "ordeal_world-1.0.dist-info"
    metadata.mkdir(parents=True)
    (metadata / "METADATA").write_text("Metadata-Version: 2.1\nName: ordeal-world\nVersion: 1\n")
    entries = ("witnessed = ordeal_world:within", "witnessed_apart = ordeal_world:apart")
    (metadata / "entry_points.txt").write_text("\n".join(["[mend.worlds]", *entries]))
