"""What is said of a judged localizer: as sentences, as plain values, and as one HTML file."""

from dataclasses import dataclass
from importlib.metadata import version
from math import degrees
from pathlib import Path
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

from mend.localization.judging.verdict import Judgement, Moment, Standing, Stretch
from mend.localization.pose import relative

_SAID = {
    Standing.LOST: "lost",
    Standing.NEITHER: "unclear: the scans fit neither its track nor ours",
}


@dataclass(frozen=True, slots=True, eq=False)
class JudgedDrive:
    """A judgement, and of what: the drive, the judged topic, our method, the map."""

    judgement: Judgement
    drive: str
    topic: str
    method: str
    map_name: str
    picture: str
    """As SVG."""


def verdict_of(judgement: Judgement) -> str:
    """The whole drive in a sentence."""
    lost = judgement.lost
    unclear = [each for each in judgement.stretches if each.standing is Standing.NEITHER]
    if lost:
        times = "once" if len(lost) == 1 else f"{len(lost)} times"
        said = (
            f"It was lost {times}, first from {lost[0].since.along_m:.1f} m on, "
            f"over {sum(_length_m(each, judgement) for each in lost):.1f} m in all."
        )
    elif judgement.counts(Standing.OPEN):
        said = "It was not seen lost."
    else:
        said = "It was never lost."
    if unclear:
        length_m = sum(_length_m(each, judgement) for each in unclear)
        said += f" On {length_m:.1f} m the scans fit neither its track nor ours."
    if open_m := judgement.metres_of(Standing.OPEN):
        said += f" On {open_m:.1f} m the tracks part and the scans do not say who is right."
    return said


def sentences(judgement: Judgement) -> list[str]:
    """One for each stretch, in the order of the way."""
    return [_sentence(each, judgement.begins_s) for each in judgement.stretches]


def as_plain(judged: JudgedDrive) -> dict[str, Any]:
    """The judgement for programs."""
    judgement = judged.judgement
    return {
        "drive": judged.drive,
        "judged": judged.topic,
        "method": judged.method,
        "steps": len(judgement.standings),
        "path_m": judgement.along_m[-1],
        "lost_m": judgement.metres_of(Standing.LOST),
        "neither_m": judgement.metres_of(Standing.NEITHER),
        "open_m": judgement.metres_of(Standing.OPEN),
        "ours_corrected": len(judgement.ours_corrected),
        "stretches": [_plain_stretch(each) for each in judgement.stretches],
    }


def write_judged_report(path: Path, judged: JudgedDrive) -> None:
    """Write the page. Raises `OSError`."""
    environment = Environment(
        loader=PackageLoader("mend.server.report"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    judgement = judged.judgement
    text = environment.get_template("judged.html").render(
        judged=judged,
        status="lost" if judgement.lost else "held",
        verdict=verdict_of(judgement),
        figures=_figures(judgement),
        facts=[
            ("Drive", judged.drive),
            ("Judged", judged.topic),
            ("Beside it", judged.method),
            ("Map", judged.map_name),
        ],
        rows=[_row(number, each, judged) for number, each in enumerate(judgement.stretches, 1)],
        picture=Markup(judged.picture),
        version=version("mend-robots"),
    )
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")


def _figures(judgement: Judgement) -> list[tuple[str, str]]:
    return [
        (f"{judgement.along_m[-1]:.0f} m", "driven"),
        (str(len(judgement.lost)), "times lost"),
        (f"{judgement.metres_of(Standing.LOST):.1f} m", "lost"),
        (f"{judgement.metres_of(Standing.NEITHER):.1f} m", "neither track fits"),
        (f"{judgement.metres_of(Standing.OPEN):.1f} m", "not decided"),
        (str(len(judgement.ours_corrected)), "times ours was the wrong one"),
    ]


def _row(number: int, stretch: Stretch, judged: JudgedDrive) -> tuple[str, ...]:
    away_m, turned = _apart(stretch.said)
    until = stretch.until
    x, y, _ = stretch.since.ours
    return (
        str(number),
        stretch.standing.value,
        f"{stretch.since.along_m:.1f} m",
        f"{stretch.since.time_s - judged.judgement.begins_s:.1f} s",
        f"{x:.2f}, {y:.2f} m",
        "the end" if until is None else f"{until.along_m:.1f} m",
        f"{stretch.said.along_m:.1f} m",
        f"{away_m:.2f} m, {turned:.0f}°",
        f"{stretch.furthest_m:.2f} m",
        f"{stretch.ours_matched:.0%}",
        f"{stretch.theirs_matched:.0%}",
    )


def _sentence(stretch: Stretch, begins_s: float) -> str:
    away_m, turned = _apart(stretch.said)
    x, y, _ = stretch.since.ours
    until = "the end" if stretch.until is None else f"{stretch.until.along_m:.1f} m"
    return (
        f"{_SAID[stretch.standing]} since {stretch.since.along_m:.1f} m "
        f"({stretch.since.time_s - begins_s:.1f} s, at {x:.2f}, {y:.2f} m) until {until}; clear by "
        f"{stretch.said.along_m:.1f} m, then {away_m:.2f} m and {turned:.0f} degrees off; the map "
        f"foretells {stretch.theirs_matched:.0%} of what is seen from its track, "
        f"{stretch.ours_matched:.0%} from ours"
    )


def _plain_stretch(stretch: Stretch) -> dict[str, Any]:
    away_m, turned = _apart(stretch.said)
    return {
        "standing": stretch.standing.value,
        "since": _plain_moment(stretch.since),
        "said": _plain_moment(stretch.said),
        "until": None if stretch.until is None else _plain_moment(stretch.until),
        "off_m": away_m,
        "off_deg": turned,
        "furthest_m": stretch.furthest_m,
        "ours_matched": stretch.ours_matched,
        "theirs_matched": stretch.theirs_matched,
    }


def _plain_moment(moment: Moment) -> dict[str, Any]:
    return {
        "step": moment.step,
        "stamp_s": moment.time_s,
        "along_m": moment.along_m,
        "ours": moment.ours.tolist(),
        "theirs": moment.theirs.tolist(),
    }


def _apart(moment: Moment) -> tuple[float, float]:
    """Metres and degrees between the tracks."""
    away = relative(moment.ours, moment.theirs)
    return float((away[0] ** 2 + away[1] ** 2) ** 0.5), degrees(abs(float(away[2])))


def _length_m(stretch: Stretch, judgement: Judgement) -> float:
    end_m = judgement.along_m[-1] if stretch.until is None else stretch.until.along_m
    return end_m - stretch.since.along_m
