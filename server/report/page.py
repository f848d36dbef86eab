"""The page of a report: everything it shows, rendered into one HTML file that needs no other."""

import base64
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from uuid import UUID

from jinja2 import Environment, PackageLoader, StrictUndefined

from mend.server.journal import events as ev
from mend.server.report.record import Fault, RunRecord
from mend.server.report.timeline import lay_out_timeline
from mend.server.report.tree_drawing import draw_tree
from mend.server.report.tree_state import node_states
from mend.server.transcript import Transcript
from mend.server.transcript_line import SPOKEN, Line, grouped
from mend.server.transcript_words import joined, told_missing, why_aborted

MAX_CANDIDATES = 8
"""Of each choice, so many candidates are shown."""

MAX_MISSING = 5
"""Of the parts that the last look did not find, the verdict names so many."""


def write_report(path: Path, events: Sequence[ev.Event], pictures: Mapping[UUID, bytes]) -> None:
    """Write the report of one run, all of whose events are given, to a file.

    `pictures` are JPEGs by the id that an issue gives. Raises `ValueError` as `RunRecord` does and
    `OSError` when the file cannot be written.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(render_report(events, pictures), encoding="utf-8")


def render_report(events: Sequence[ev.Event], pictures: Mapping[UUID, bytes]) -> str:
    """The report as HTML. Raises `ValueError` as `RunRecord` does."""
    record = RunRecord(events)
    transcript = Transcript()
    lines = [line for event in events for line in transcript.lines(event)]
    states = node_states(record)
    environment = Environment(
        loader=PackageLoader("mend.server.report"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    return environment.get_template("report.html").render(
        record=record,
        started=record.started,
        verdict=_verdict(record),
        facts=_facts(record),
        figures=_figures(record),
        timeline=lay_out_timeline(record),
        tree=draw_tree(states),
        swatches=_swatches(record.started),
        objects={each.path: each.object for each in states},
        faults=[_fault_card(each, transcript, pictures) for each in record.faults],
        choices=[_choice(each.started) for each in record.executions],
        transcript=list(grouped(lines)),
        spoken=SPOKEN,
        version=version("mend-robots"),
    )


# --- The header -------------------------------------------------------------------------------


def _verdict(record: RunRecord) -> str:
    match record.end:
        case ev.RunFinished(missing=[], unseen=[]):
            return "The task is done, and the last look found no part gone from its place."
        case ev.RunFinished(missing=[], unseen=unseen):
            hidden = joined([each.object for each in unseen])
            return (
                "The task is done, and the last look found no part gone from its place; something "
                f"hides {hidden} from it."
            )
        case ev.RunFinished(missing=missing):
            parts = [told_missing(each) for each in missing[:MAX_MISSING]]
            if (more := len(missing) - len(parts)) > 0:
                parts.append(f"{more} more are not at their places")
            return f"The task is done, but {joined(parts)}."
        case ev.RunFailed(reason=reason):
            return f"The run failed: {reason}."
        case ev.RunAborted() as aborted:
            return f"The run was aborted: {why_aborted(aborted)}."
    return "The run has not ended."


def _facts(record: RunRecord) -> list[tuple[str, str]]:
    started = record.started
    facts = [
        ("World", started.world),
        ("Scenario", started.scenario or "none"),
        ("Speed", str(started.speed)),
        ("Seed", str(started.seed)),
        ("Robots", ", ".join(started.robots)),
        ("Begun", f"{started.wall_time:%Y-%m-%d %H:%M:%S} UTC"),
        ("Run", str(started.run)),
    ]
    if resolutions := Counter(str(each.resolution) for each in record.faults if each.resolution):
        counts = ", ".join(f"{name} ({count})" for name, count in resolutions.items())
        facts.insert(0, ("Resolved by", counts))
    return facts


def _figures(record: RunRecord) -> list[tuple[str, str]]:
    answers = sum(isinstance(each, ev.Answered) for each in record.events)
    figures = [
        (len(record.done), "leaf done", "leaves done"),
        (len(record.executions), "start of a leaf", "starts of a leaf"),
        (len(record.faults), "issue raised", "issues raised"),
        (answers, "answer given", "answers given"),
        (len(record.interventions), "intervention", "interventions"),
    ]
    return [
        (f"{record.end_s:.1f} s", "on the run's clock"),
        *((str(count), one if count == 1 else many) for count, one, many in figures),
    ]


def _swatches(started: ev.RunStarted) -> dict[str, str]:
    """The colour of each object of the scene as CSS."""
    objects = started.scene.get("objects", {})
    return {name: _css_color(each["color"]) for name, each in objects.items()}


def _css_color(linear: Sequence[float]) -> str:
    """Linear RGB in [0, 1] as sRGB (IEC 61966-2-1)."""
    channels = [
        12.92 * each if each <= 0.0031308 else 1.055 * each ** (1 / 2.4) - 0.055 for each in linear
    ]
    return "#" + "".join(f"{round(255 * min(max(each, 0.0), 1.0)):02x}" for each in channels)


# --- Faults and choices -----------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class FaultCard:
    """One fault as the page shows it; `picture` is a data URI."""

    fault: Fault
    picture: str | None
    explanation: str
    camera: str | None
    lines: list[Line]


def _fault_card(fault: Fault, transcript: Transcript, pictures: Mapping[UUID, bytes]) -> FaultCard:
    raised = fault.raised
    jpeg = pictures.get(raised.picture) if raised.picture else None
    detection = raised.detection
    return FaultCard(
        fault=fault,
        picture=None
        if jpeg is None
        else "data:image/jpeg;base64," + base64.b64encode(jpeg).decode("ascii"),
        explanation=detection.explanation if detection else "",
        camera=detection.camera if detection else None,
        lines=[line for event in fault.story for line in transcript.lines(event)],
    )


@dataclass(frozen=True, slots=True)
class ShownChoice:
    """One start of a leaf and what it was chosen from; `scale` is the highest potential."""

    started: ev.NodeStarted
    candidates: list[ev.Candidate]
    hidden: int
    scale: float


def _choice(started: ev.NodeStarted) -> ShownChoice:
    shown = started.candidates[:MAX_CANDIDATES]
    return ShownChoice(
        started=started,
        candidates=shown,
        hidden=len(started.candidates) - len(shown),
        scale=max((each.potential for each in shown), default=0.0) or 1.0,
    )
