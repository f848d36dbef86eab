"""What a client asks of a run, checked at the edge."""

from typing import Annotated, Literal
from uuid import UUID

from pydantic import BaseModel, ConfigDict, Discriminator, Field, Tag

from mend.tasks.autonomy import AutonomyLevel
from mend.tasks.scenario import Person

MOST = 2**53 - 1
"""Up to here any reader of JSON can tell whole numbers from their neighbours."""

WorldOption = (
    bool
    | Annotated[int, Field(ge=-MOST, le=MOST)]
    | Annotated[float, Field(ge=-MOST, le=MOST)]
    | str
)

RobotList = Annotated[list[str], Field(max_length=64), Tag("list")]
RobotsByPlace = Annotated[dict[str, str], Field(max_length=64), Tag("places")]


def _is_by_place(robots: object) -> str:
    return "places" if isinstance(robots, dict) else "list"


Robots = Annotated[RobotList | RobotsByPlace, Discriminator(_is_by_place)]


class RunRequest(BaseModel):
    """Start a run of a task tree in a world.

    `answers`: a scripted helper's answers, `random` (from the seed), `none` (nobody ever answers)
    or `live` (helpers do); None means the scenario's answers, and live helpers where it has none.
    `interventions`: `random` has a simulated person steal, move and block, by the seed. `robots`:
    the connected robots that do it in world `live`: a list of names, or, by which robot of the
    scene each of them is, `{"left": "arm-1", "right": "arm-2"}`. `site`: where it is to be, which
    then says the world, its scene, seed and speed; `robots` are then those of the site that it is
    to have, all without it. `scene` names a scene to do the tree in instead of the one that it is
    for; it has to have everything that the tree names.
    """

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)

    tree: Annotated[str, Field(min_length=1, max_length=64)]
    world: Annotated[str, Field(min_length=1, max_length=64)] = "workcell"
    speed: Annotated[float, Field(gt=0, le=1000, allow_inf_nan=False)] | Literal["max"] = 1.0
    seed: Annotated[int, Field(ge=0, le=2**31 - 1)] = 0
    scenario: Annotated[str, Field(min_length=1, max_length=64)] | None = None
    scene: Annotated[str, Field(min_length=1, max_length=64)] | None = None
    answers: list[Literal["yes", "no", "silence"]] | Literal["random", "none", "live"] | None = None
    interventions: Literal["random"] | None = None
    person: Person | None = None
    robots: Robots = []
    max_attempts: Annotated[int, Field(ge=1, le=100)] = 3
    world_options: dict[str, WorldOption] = {}
    site: Annotated[UUID | None, Field(strict=False)] = None
    autonomy: Annotated[AutonomyLevel, Field(strict=False)] = AutonomyLevel.FULL
