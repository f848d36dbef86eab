"""Interventions: what a person does in a world."""

from enum import StrEnum
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from mend.documents.strict_model import StrictModel
from mend.tasks.scene import Name, Pose


class Act(StrEnum):
    """The kinds of intervention."""

    STEAL = "steal"
    """Take the object away, out of the robot's gripper if need be."""
    PUT_BACK = "put_back"
    """Put the object to where it started."""
    PLACE = "place"
    """Put the object to its final place."""
    HAND_OVER = "hand_over"
    """Hold the object between the fingers until the robot has gripped it."""
    MOVE = "move"
    """Put the object somewhere else (`to`)."""
    BLOCK = "block"
    """Stand in the way of the arm."""
    RELEASE = "release"
    """Get out of the way, and put aside the object, or what lies at the place where it is to go."""
    COVER = "cover"
    """Cover the head camera."""
    UNCOVER = "uncover"
    """Clear the view of the head camera."""
    PUT_IN = "put_in"
    """Put into a robot's basket what it asks for, or what somebody took out of it on its way."""
    TAKE_OUT = "take_out"
    """Take out of a robot's basket what it hands over."""
    CHARGE = "charge"
    """Plug in a robot that stands with little left in its battery, or all of them."""
    BAR = "bar"
    """Bar a way of a building: lock its doors, or put things right across it."""
    CLEAR = "clear"
    """Unlock what was locked on a way, or take away what was put across it."""
    SEND_PERSON = "send_person"
    """Tell those who are to be escorted by robots that stand to come to them."""
    MISDIRECT = "misdirect"
    """Press another button in an elevator: who rides next is taken to a wrong floor first."""


OF_BUILDINGS = frozenset(
    {
        Act.PUT_IN,
        Act.TAKE_OUT,
        Act.CHARGE,
        Act.BAR,
        Act.CLEAR,
        Act.SEND_PERSON,
        Act.MISDIRECT,
    }
)
"""What people do in buildings only."""

_WITHOUT_OBJECT = {Act.BLOCK, Act.RELEASE, Act.COVER, Act.UNCOVER} | OF_BUILDINGS
_OF_WAYS = (Act.BAR, Act.CLEAR)
PlaceOfBuilding = Annotated[str, Field(min_length=1, max_length=130)]
"""A place of a building with its floor, as `F1/hall`."""


ElevatorName = Annotated[str, Field(min_length=1, max_length=64)]


class Intervention(StrictModel):
    """One thing that a person does in a world.

    `object` is required by every act but `block`, `release`, `cover`, `uncover`, `charge`,
    `send_person`, `bar`, `clear`, `misdirect`, and `put_in` and `take_out`, which are about any
    robot that asks for it where they name none, as `charge` is about all robots; `place` (a name of
    the scene) by `place`; `to` by `move`. A `release` with both `object` and `place` frees that
    place as well, one with an `object` alone puts that aside. `manner` says how `steal` takes the
    object: `vanish` at once, or `pull` it out of the gripper by force. `between`: the neighbouring
    places of a building whose way is to be barred, or cleared; `elevator`: the one of a building
    that is misdirected.
    """

    act: Annotated[Act, Field(strict=False)]
    object: Name | None = None
    place: Name | None = None
    to: Pose | None = None
    manner: Literal["vanish", "pull"] = "vanish"
    between: Annotated[tuple[PlaceOfBuilding, PlaceOfBuilding] | None, Field(strict=False)] = None
    elevator: ElevatorName | None = None

    @model_validator(mode="after")
    def _require_what_the_act_needs(self) -> Self:
        if self.act not in _WITHOUT_OBJECT and self.object is None:
            raise ValueError(f"act '{self.act}' needs an 'object'")
        if self.act is Act.MOVE and self.to is None:
            raise ValueError("act 'move' needs a pose 'to'")
        if self.act in _OF_WAYS and self.between is None:
            raise ValueError(f"act '{self.act}' needs two places 'between' which the way is")
        if self.act is Act.MISDIRECT and self.elevator is None:
            raise ValueError("act 'misdirect' needs an 'elevator'")
        return self
