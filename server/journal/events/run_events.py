"""Events of a run as a whole: how it began, what it waits for, how it ended."""

from typing import Any, Literal
from uuid import UUID

from mend.server.journal.events.event import Author, Event, EventModel
from mend.tasks.intervention import Intervention


class RunStarted(Event):
    """A run began; everything needed to fold it again is here.

    `tree` and `scene` are the checked definitions in their JSON form; `options` the request's
    remaining fields. `site` is where it is, None in a world of its own; `at_s` what the site's
    clock said then, where the run's begins, None where nobody knew and in the journals of an older
    Mend. `script` is the scenario's definition in its JSON form, None without one and in the
    journals of an older Mend, whose scenarios are all built in. `author` is None there, too.
    """

    type: Literal["run_started"] = "run_started"
    tree_name: str
    tree: dict[str, Any]
    scene: dict[str, Any]
    world: str
    robots: list[str]
    seed: int
    speed: float | Literal["max"]
    scenario: str | None
    script: dict[str, Any] | None = None
    options: dict[str, Any]
    author: Author | None = None
    site: UUID | None = None
    at_s: float | None = None


class InterventionAccepted(Event):
    """A person is to do something in a simulated world; journaled before the world hears of it.

    An `intervention` with the same `command` follows once it is done.
    """

    type: Literal["intervention_accepted"] = "intervention_accepted"
    act: str
    object: str | None
    intervention: Intervention
    by: str
    command: str
    author: Author | None = None


class InterventionDone(Event):
    """A person did something in a simulated world; `by` says who (scenario, helper, api, ...).

    `command` is that of the `intervention_accepted` that it follows from, if it does.
    """

    type: Literal["intervention"] = "intervention"
    act: str
    object: str | None
    intervention: Intervention
    by: str
    ok: bool = True
    detail: str = ""
    command: str | None = None


class RunPaused(Event):
    type: Literal["run_paused"] = "run_paused"
    author: Author | None = None


class RunResumed(Event):
    type: Literal["run_resumed"] = "run_resumed"
    author: Author | None = None


class MissingPart(EventModel):
    """A leaf whose object is not at its place at the end, as it was left out.

    `left_out_by`: the helper who said so; None in the journal of an older Mend, which did not ask.
    `nowhere`: the leaf handles no object that could be seen at a place; `object` is then what it
    carries, or its own name.
    """

    node: str
    name: str
    object: str
    place: str
    left_out_by: str | None = None
    nowhere: bool = False


class UnseenPart(EventModel):
    """A done leaf whose object the last look could not see, as something hides its place."""

    node: str
    name: str
    object: str
    place: str


class RecordingBegun(Event):
    """Somebody wants what the cameras of these robots see, for some seconds from now on."""

    type: Literal["recording_begun"] = "recording_begun"
    robots: list[str]
    seconds: float
    by: str
    author: Author | None = None


class RecordedPicture(EventModel):
    """A picture of a camera, at `/api/pictures/{picture}`; `time` on the run's clock."""

    camera: str
    time: float
    picture: UUID


class CamerasRecorded(Event):
    """What a robot's cameras saw around a fault, or because somebody wanted it, oldest first."""

    type: Literal["cameras_recorded"] = "cameras_recorded"
    robot: str
    pictures: list[RecordedPicture]
    size_bytes: int = 0
    """Of all these pictures."""


class RunFinished(Event):
    """The task is done. `missing`: what was left out, as a helper said; `unseen`: what is hidden.

    The journal of an older Mend does not tell what was hidden.
    """

    type: Literal["run_finished"] = "run_finished"
    missing: list[MissingPart]
    unseen: list[UnseenPart] = []


class RunFailed(Event):
    """The run cannot go on; `node` is the leaf that could not be done, if it was one."""

    type: Literal["run_failed"] = "run_failed"
    reason: str
    node: str | None = None


class RunAborted(Event):
    type: Literal["run_aborted"] = "run_aborted"
    reason: str = ""
    author: Author | None = None
