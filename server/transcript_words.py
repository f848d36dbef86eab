"""How a transcript, and a report, name what people did and how a run ended."""

from collections.abc import Sequence
from typing import Literal, Protocol
from uuid import UUID

from mend.dialogue.spoken import called
from mend.server.access.principal import RESERVED, SCRIPT
from mend.server.journal import events as ev
from mend.tasks.intervention import Act, Intervention

DEEDS: dict[Act, str] = {
    Act.STEAL: "takes {object} away",
    Act.PUT_BACK: "puts {object} back",
    Act.PLACE: "puts {object} to its place",
    Act.HAND_OVER: "hands {object} over",
    Act.MOVE: "moves {object}",
    Act.BLOCK: "stands in the robot's way",
    Act.RELEASE: "helps the robot go on",
    Act.COVER: "covers the head camera",
    Act.UNCOVER: "clears the head camera's view",
    Act.PUT_IN: "puts {object} into the robot's basket",
    Act.TAKE_OUT: "takes {object} out of the robot's basket",
    Act.CHARGE: "plugs the robot in",
    Act.BAR: "bars the way between {between}",
    Act.CLEAR: "clears the way between {between}",
    Act.SEND_PERSON: "tells who is to follow a robot to come",
    Act.MISDIRECT: "presses a wrong button in {elevator}",
}


def by(author: ev.Author | None) -> str:
    """Who did something, after what they did; nothing where they have no name."""
    return "" if author is None or author.principal in RESERVED else f" by {author.principal}"


def why_aborted(event: ev.RunAborted) -> str:
    """Why a run was aborted, or by whom."""
    return event.reason or by(event.author).strip() or "by a person"


class StartedRun(Protocol):
    """How a run was begun."""

    @property
    def world(self) -> str: ...

    @property
    def seed(self) -> int: ...

    @property
    def speed(self) -> float | Literal["max"]: ...

    @property
    def scenario(self) -> str | None: ...


def told_start(run: UUID, tree: str, started: StartedRun) -> str:
    """That a run begins, of which tree, and how."""
    scenario = f", scenario {started.scenario}" if started.scenario else ""
    speed = started.speed if started.speed == "max" else f"{started.speed:g}"
    return (
        f"run {run} of {tree} begins in {started.world} "
        f"(seed {started.seed}, speed {speed}{scenario})"
    )


def deed_text(intervention: Intervention) -> str:
    """What a person does, as the end of a sentence that begins with who it is."""
    text = DEEDS[intervention.act].format(
        object=intervention.object or "something",
        between=" and ".join(intervention.between or ()),
        elevator=intervention.elevator,
    )
    if intervention.act is Act.STEAL and intervention.manner == "pull":
        text = f"pulls {intervention.object} out of the gripper"
    if intervention.act is Act.CHARGE and intervention.object:
        text = f"plugs {called(intervention.object)} in"
    if intervention.act is Act.RELEASE and intervention.object and intervention.place is None:
        text = f"puts {intervention.object} aside"
    return text


def told_deed(event: ev.InterventionDone | ev.SiteIntervention) -> str:
    """What a person did, and why in vain, if so."""
    text = deed_text(event.intervention)
    return text if event.ok else f"{text}: in vain, {event.detail}"


def finished_text(missing: Sequence[ev.MissingPart], unseen: Sequence[ev.UnseenPart] = ()) -> str:
    """What a finished run came to: what was left out, and what nobody can see now."""
    hidden = joined([each.object for each in unseen])
    return _without(missing) + (
        f"; the last look could not tell whether {hidden} stayed there" if hidden else ""
    )


def _without(missing: Sequence[ev.MissingPart]) -> str:
    if not missing:
        return "the task is done"
    said: dict[str | None, list[str]] = {}
    for each in missing:
        said.setdefault(each.left_out_by, []).append(each.object)
    parts = (
        f"without {joined(list(dict.fromkeys(objects)))}{_as_said(by)}"
        for by, objects in said.items()
    )
    return f"the task is done {joined(list(parts))}"


def told_missing(part: ev.MissingPart) -> str:
    """That a part is not at its place at the end, and who said to go on without it."""
    if part.nowhere:
        return f"{part.name} was left out{_as_said(part.left_out_by)}"
    return f"{part.object} is not at {part.place}{_as_said(part.left_out_by)}"


def _as_said(by: str | None) -> str:
    return "" if by is None else f", {as_said(by)}"


def as_said(helper: str) -> str:
    """Who has said something; the answers that a run was given beforehand are nobody's name."""
    return f"as {'the script' if helper == SCRIPT else helper} said"


def joined(words: Sequence[str]) -> str:
    """The words as an enumeration: `a, b and c`."""
    return " and ".join(filter(None, (", ".join(words[:-1]), *words[-1:])))
