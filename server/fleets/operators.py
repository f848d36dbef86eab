"""What operators say to a fleet: of ways, and of robots."""

from mend.documents.near_names import names_near
from mend.errors import ConflictError, NotFoundError, WrongInputError
from mend.fleet.dispatch.leg import Finding, Found
from mend.server.access.principal import RESERVED
from mend.server.fleets.errands import Errands
from mend.server.fleets.fleet_book import FleetBook
from mend.server.fleets.legs_under_way import LegsUnderWay
from mend.server.fleets.operator_requests import WayReport
from mend.server.journal import events as ev


class Operators:
    """Does with one fleet what operators say."""

    def __init__(self, book: FleetBook, errands: Errands, legs: LegsUnderWay) -> None:
        self._book, self._errands, self._legs = book, errands, legs

    async def found(self, way: WayReport, author: ev.Author | None) -> None:
        """A way was found blocked, or open.

        Raises as `Dispatcher.found`, and `WrongInputError` where it is to last until what is over,
        or there is no such door.
        """
        a, b = way.between or self._stops_of(way.elevator or "")
        if way.finding == "door_closed":
            self._require_door(a, b)
        what = f"the way between {a} and {b}" if way.elevator is None else way.elevator
        found = Found(finding=Finding(way.finding), between=(a, b), until_s=way.until_s)
        async with self._book.told():
            self._require_to_come(way)
            dispatcher, now_s = self._book.dispatcher, self._book.now_s
            await self._book.in_thread(dispatcher.found, found, now_s)
            named = author is not None and author.principal not in RESERVED
            self._book.closed_ways.note(found, author.principal if author and named else None)
            finding = way.finding.replace("_", " ")
            self._note(f"said of {what}: {finding}", author)

    def _require_door(self, a: str, b: str) -> None:
        building = self._book.dispatcher.building
        ends = {building.find(a), building.find(b)}
        for each in building.crossings:
            if {f"{each.floor}/{end}" for end in each.lane.between} == ends and not each.doors:
                raise WrongInputError(f"no door is between '{a}' and '{b}': say 'blocked'")

    def _require_to_come(self, way: WayReport) -> None:
        if way.until_s is not None and way.until_s <= self._book.shown_s:
            raise WrongInputError(
                f"until_s must be after {self._book.shown_s:g} s, which is now by the clock of the "
                f"site, but it is {way.until_s:g} s"
            )

    def _stops_of(self, elevator: str) -> list[str]:
        """Two places where it stops. Raises `NotFoundError`."""
        elevators = self._book.dispatcher.building.document.elevators
        if elevator not in elevators:
            raise NotFoundError(
                f"there is no elevator '{elevator}'; there is {names_near(elevator, elevators)}"
            )
        return [f"{floor}/{at}" for floor, at in elevators[elevator].stops.items()][:2]

    async def take_out(self, robot: str, reason: str, author: ev.Author | None) -> None:
        """A robot is to do nothing more for now; others fetch what it has.

        Raises `NotFoundError`, and `ConflictError` where it is out of service already.
        """
        async with self._book.told():
            self._book.require_robot(robot)
            if robot in self._book.out_of_service:
                raise ConflictError(f"robot '{robot}' is out of service already")
            self._book.out_of_service[robot] = reason
            self._note(f"took {robot} out of service: {reason}", author, robot, in_service=False)
            dispatcher, errand = self._book.dispatcher, self._errands.going.get(robot)
            leg = next((e for e in dispatcher.legs_under_way() if e.robot == robot), None)
            if leg is None and dispatcher.fleet.robots[robot].works:
                at = self._book.met_at(robot)
                now_s = self._book.now_s
                await self._book.in_thread(dispatcher.robot_failed, robot, at, reason, now_s)
        execution = self._legs.executions.get(robot)
        if leg is not None and execution is not None:
            await execution.break_off(f"{robot} was taken out of service: {reason}")
        if errand is not None:
            await self._errands.break_off(errand)

    async def send(self, robot: str, place: str, author: ev.Author | None) -> None:
        """Have a robot that carries out no leg go to a place; its legs begin after that.

        Raises `NotFoundError`, `WrongInputError` for where no robot goes, and `ConflictError` for
        a robot that is at work, or is not there.
        """
        async with self._book.told():
            self._book.require_robot(robot)
            self._book.places.in_scene(place)
            self._errands.require_free(robot)
            self._errands.send(robot, self._book.dispatcher.building.find(place), author)

    async def put_back(self, robot: str, author: ev.Author | None) -> None:
        """A robot works again, from where it stands.

        Raises `NotFoundError`, and `ConflictError` where nobody has taken it out of service.
        """
        async with self._book.told():
            self._book.require_robot(robot)
            if self._book.out_of_service.pop(robot, None) is None:
                raise ConflictError(f"robot '{robot}' is in service")
            self._note(f"put {robot} back in service", author, robot, in_service=True)

    def _note(
        self,
        told: str,
        author: ev.Author | None,
        robot: str | None = None,
        in_service: bool | None = None,
    ) -> None:
        """Something an operator has told, to be journaled with what comes of it."""
        told_of = self._book.news.told(told, author, robot=robot, in_service=in_service)
        self._book.note(told_of)
