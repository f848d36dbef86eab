"""What commands mean to an arm: which behavior, part and place their names stand for."""

from collections.abc import Collection, Iterable, Mapping

from mend.robots.arm.behaviors.assignment import Assignment
from mend.robots.arm.behaviors.behavior import ArmBehavior
from mend.robots.arm.result import JudgedResult
from mend.robots.catalogue import Catalogue, Part
from mend.robots.execution.behavior import read_parameters
from mend.robots.execution.command_error import CommandError
from mend.robots.link.messages import FinishedResult, Location, Look, Start


class CommandResolver:
    """An arm's behaviors, and the parts and places that it knows."""

    def __init__(
        self,
        behaviors: Mapping[str, type[ArmBehavior]],
        catalogue: Catalogue,
        known_colors: Collection[str],
    ) -> None:
        self._behaviors = dict(behaviors)
        self._catalogue = catalogue
        self._known_colors = known_colors

    def assign(self, start: Start) -> Assignment:
        """What a start command of one of its behaviors asks for. Raises `CommandError`."""
        behavior = self._behaviors[start.behavior]
        parameters = read_parameters(behavior, start)
        part = self.part(getattr(parameters, "object", None), start.size)
        target = start.target or self.target(getattr(parameters, "place", None))
        needs_help = bool(getattr(parameters, "needs_help", False))
        return Assignment(
            execution=start.execution,
            behavior=behavior(),
            parameters=parameters,
            part=part,
            target=target,
            needs_help=needs_help or (part is not None and part.needs_help),
            was_done=start.was_done,
            finished=self.results_of(start.finished),
        )

    def part(self, name: str | None, size: tuple[float, float, float] | None) -> Part | None:
        """The part of a name; `size` for one that is not known. Raises `CommandError`."""
        if name is None:
            return None
        part = self._catalogue.parts.get(name)
        if part is None:
            if size is None:
                raise CommandError(f"object '{name}' is unknown, and the command gives no size")
            part = Part(name, size)
        if name not in self._known_colors:
            raise CommandError(f"the colour model was not trained for object '{name}'")
        return part

    def target(self, name: str | None) -> Location | None:
        """Where a place is. Raises `CommandError`."""
        if name is None:
            return None
        target = self._catalogue.places.get(name)
        if target is None:
            raise CommandError(f"place '{name}' is unknown, and the command gives no target")
        return target

    def object_of(self, look: Look) -> Part:
        """What a look is for. Raises `CommandError`."""
        part = self.part(look.object, None)
        if part is None:
            raise CommandError(f"a look for '{look.expect}' needs an object")
        return part

    def results_of(self, finished: Iterable[FinishedResult]) -> list[JudgedResult]:
        """Finished results, as far as this robot knows them."""
        parts, places = self._catalogue.parts, self._catalogue.places
        return [
            JudgedResult(each, parts[each.object], places[each.place])
            for each in finished
            if each.object in self._known_colors and each.object in parts and each.place in places
        ]

    def place_of(self, look: Look) -> Location:
        """Where a look expects its object. Raises `CommandError`."""
        target = self.target(look.place)
        if target is None:
            raise CommandError(f"a look for '{look.expect}' needs a place")
        return target
