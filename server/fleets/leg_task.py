"""The runs of a leg: their ids, what is asked of them, and their tasks of one leaf."""

from collections.abc import Mapping
from enum import StrEnum
from typing import Any
from uuid import UUID, uuid5

from mend.documents.validation import refusing
from mend.errors import WrongInputError
from mend.fleet.dispatch.booking import AnyRequest
from mend.fleet.dispatch.dispatcher import Dispatcher
from mend.fleet.dispatch.leg import Leg
from mend.fleet.requests import (
    REQUESTS,
    DeliverMessage,
    Escort,
    LegAction,
    RequestKind,
    Transport,
)
from mend.robots.execution.behavior import Behavior
from mend.server.fleets.item_names import item_of
from mend.server.runtime.requests import RunRequest
from mend.server.sites.requests import FleetOptions
from mend.tasks.definition import BehaviorNode, TaskTreeDefinition
from mend.tasks.scenario import Person

GO_TO = "go_to"
CHARGE = "charge"
HAND_OVER = "hand_over_item"
BEHAVIORS = {
    LegAction.DELIVER_MESSAGE: "deliver_message",
    LegAction.MEET: "meet_person",
    LegAction.ESCORT: "escort",
    LegAction.COLLECT: "collect_item",
    LegAction.TAKE: "collect_item",
    LegAction.HAND_OVER: HAND_OVER,
    LegAction.GIVE: HAND_OVER,
    LegAction.BRING_BACK: HAND_OVER,
}
"""What robots do at the end of a leg, where there is more to it than being there."""
ASKED_IN_VAIN = 2
"""When it is put, and when it is put again: then a question goes to somebody else."""
MOST_ANSWERS = 20
"""So often a simulated person answers in one run."""


class LegStage(StrEnum):
    """What a run does of its leg."""

    GO = "go"
    DO = "do"


def run_of(site: UUID, robot: str, number: int, stage: LegStage) -> UUID:
    """The id of the run of a robot's leg: the same one, however often it is asked for."""
    return uuid5(site, f"{robot} {number} {stage}")


def run_request(site: UUID, leg: Leg, options: FleetOptions) -> RunRequest:
    """A run of the leg's robot at the site."""
    return _request(site, leg.action, leg.robot, options)


def way_request(site: UUID, robot: str, options: FleetOptions) -> RunRequest:
    """A run in which a robot only goes somewhere."""
    return _request(site, GO_TO, robot, options)


def _request(site: UUID, tree: str, robot: str, options: FleetOptions) -> RunRequest:
    request = RunRequest(tree=tree, site=site, robots=[robot], answers="live")
    if options.answers == "live":
        return request
    first = ["silence"] * ASKED_IN_VAIN if options.answers == "late" else []
    person = {"answers": [*first, *["yes"] * MOST_ANSWERS], "person": Person(acts=True)}
    return request.model_copy(update=person)


def doable_kinds(behaviors: Mapping[str, type[Behavior]]) -> list[RequestKind]:
    """The kinds of requests that behaviors of robots can do."""
    return [
        kind
        for kind, model in REQUESTS.items()
        if all(
            BEHAVIORS.get(each) in behaviors
            for each in {model.fetching, model.bringing} - {LegAction.VISIT}
        )
    ]


def require_doable(request: AnyRequest, behaviors: Mapping[str, type[Behavior]]) -> None:
    """Raises `WrongInputError` for what no behavior of a robot does, or not with such words."""
    for action in {request.fetching, request.bringing} - {LegAction.VISIT}:
        name = BEHAVIORS.get(action)
        if name is None or name not in behaviors:
            raise WrongInputError(f"no robot here can do a request of the kind '{request.kind}'")
        parameters = {"place": "there", **_parameters(request, request.name)}
        model = behaviors[name].parameters
        with refusing(model):
            model.model_validate(parameters)


def way_of(place: str, near_m: float = 0.0) -> TaskTreeDefinition:
    """The task of going to a place, as the scene calls it, or near to it if it is not free."""
    return _leaf(GO_TO, {"place": place, "near_m": near_m} if near_m else {"place": place})


def charging_at(place: str) -> TaskTreeDefinition:
    """The task of charging at a charger, as the scene calls it, until the battery is full."""
    return _leaf(CHARGE, {"place": place})


def task_of(leg: Leg, place: str, away_m: float | None = None) -> TaskTreeDefinition:
    """The task of a leg; `place` is its place as the scene calls it.

    `away_m`: how far from there the robot stands that has what is to be taken, if it is known.

    Raises `WrongInputError` for what no behavior does.
    """
    if leg.action not in BEHAVIORS:
        raise WrongInputError(f"no behavior of a robot does '{leg.action}'")
    parameters = {"place": place, **_parameters(leg.request, leg.booking)}
    if leg.held_by is not None and leg.action is LegAction.TAKE:
        parameters["held_by"] = leg.held_by
        if away_m is not None:
            parameters["away_m"] = round(away_m, 1)
    return _leaf(BEHAVIORS[leg.action], parameters)


def taken_out(dispatcher: Dispatcher) -> dict[str, list[str]]:
    """By robot, what it is to be told that others have, as it calls these things."""
    taken = {robot: names for robot, names in dispatcher.taken_out().items() if names}
    requests = {view.name: view.request for view in dispatcher.views()} if taken else {}
    return {
        robot: [
            item_of(request.what, name, request.origin)
            for name in sorted(names)
            if isinstance(request := requests.get(name), Transport)
        ]
        for robot, names in taken.items()
    }


def _parameters(request: AnyRequest, booking: str) -> dict[str, Any]:
    match request:
        case DeliverMessage(message=message):
            return {"message": message}
        case Escort(person=person):
            return {"person": person}
        case Transport(what=what, origin=origin):
            return {"item": item_of(what, booking, origin)}
        case _:
            return {}


def _leaf(behavior: str, parameters: dict[str, Any]) -> TaskTreeDefinition:
    leaf = BehaviorNode(parent=None, name=behavior, behavior=behavior, parameters=parameters)
    return TaskTreeDefinition(name=behavior, scene=None, nodes=[leaf])
