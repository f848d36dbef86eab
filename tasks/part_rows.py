"""Several equal things under one entry of a scene file: `poses`, or a `grid` of them.

An entry `bolt` with n poses stands for the entries `bolt_1` to `bolt_n`.
"""

from typing import Annotated, Any

from pydantic import Field

from mend.documents.document import LinedMapping, LinedSequence
from mend.documents.problem import Problem
from mend.documents.strict_model import StrictModel
from mend.documents.validation import show_kind, validate_part
from mend.tasks.scene import Metres, Pose

_MOST = 1000

Count = Annotated[int, Field(ge=1, le=100)]


class Grid(StrictModel):
    """Poses in rows along x and columns along y: `first` is the one nearest to both lower ends.

    `step` is how far apart two neighbours are along x and y. Counted row after row.
    """

    first: Pose
    rows: Count
    columns: Count
    step: tuple[Metres, Metres]


def expand_rows(scene: LinedMapping) -> list[Problem]:
    """Replace each entry of `objects` and `places` that has several poses; tells what is wrong."""
    problems: list[Problem] = []
    for key in ("objects", "places"):
        entries = scene.get(key)
        if isinstance(entries, LinedMapping):
            scene[key] = _expanded(entries, problems)
    return problems


def _expanded(entries: LinedMapping, problems: list[Problem]) -> LinedMapping:
    several = {
        name: _poses_of(name, entry, problems)
        for name, entry in entries.items()
        if isinstance(entry, LinedMapping) and ("poses" in entry or "grid" in entry)
    }
    if not several:
        return entries
    expanded = LinedMapping(entries.line)
    for name, entry in entries.items():
        poses = several.get(name)
        if poses is None:
            _add(expanded, name, entry, entries.line_of(name), problems)
            continue
        for number, (pose, line) in enumerate(poses, start=1):
            one = LinedMapping(entry.line)
            one.key_lines = {**entry.key_lines, "pose": line}
            one.update((key, entry[key]) for key in entry if key not in ("poses", "grid"))
            one["pose"] = pose
            _add(expanded, f"{name}_{number}", one, line, problems)
    return expanded


def _add(entries: LinedMapping, name: str, entry: Any, line: int, problems: list[Problem]) -> None:
    if name in entries:
        message = f"there are two '{name}', the other one from line {entries.line_of(name)}"
        problems.append(Problem(line, None, message))
        return
    entries[name] = entry
    entries.key_lines[name] = line


def _poses_of(name: str, entry: LinedMapping, problems: list[Problem]) -> list[tuple[Any, int]]:
    """The poses of an entry, each with its line; none, with a problem, where they are wrong."""
    given = [key for key in ("pose", "poses", "grid") if key in entry]
    if len(given) > 1:
        message = f"'{name}' has '{given[0]}' and '{given[1]}'; it may have only one of them"
        problems.append(Problem(entry.line_of(given[1]), None, message))
        return []
    line = entry.line_of(given[0])
    value = entry[given[0]]
    if given[0] == "grid":
        return _grid_poses(name, value, line, problems)
    if not isinstance(value, LinedSequence) or not value:
        kind = "empty" if isinstance(value, LinedSequence) else show_kind(value)
        message = f"'poses' of '{name}' must be a list of poses, but it is {kind}"
        problems.append(Problem(line, None, message))
        return []
    return list(zip(value, value.item_lines, strict=True))


def _grid_poses(name: str, value: Any, line: int, problems: list[Problem]) -> list[tuple[Any, int]]:
    if not isinstance(value, LinedMapping):
        message = f"'grid' of '{name}' must be a mapping, but it is {show_kind(value)}"
        problems.append(Problem(line, None, message))
        return []
    grid, mistakes = validate_part(Grid, value)
    problems += [
        Problem(each.line, None, f"the grid of '{name}': {each.message}") for each in mistakes
    ]
    if grid is None:
        return []
    if grid.rows * grid.columns > _MOST:
        message = f"the grid of '{name}' has more than {_MOST} poses"
        problems.append(Problem(line, None, message))
        return []
    return [
        (_pose(grid, row, column, line), line)
        for row in range(grid.rows)
        for column in range(grid.columns)
    ]


def _pose(grid: Grid, row: int, column: int, line: int) -> LinedMapping:
    pose = LinedMapping(line)
    pose["x"] = round(grid.first.x + row * grid.step[0], 6)
    pose["y"] = round(grid.first.y + column * grid.step[1], 6)
    pose["z"] = grid.first.z
    pose["yaw"] = grid.first.yaw
    return pose
