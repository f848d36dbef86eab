"""Compares what a service says of its fleet with what its world really was, and has its own say.

What is believed of the service is only its journal; where everything was is the witness's truth
(`ordeal_world.py`). A finding is a sentence with the site's time.
"""

import math
from collections import Counter, defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from itertools import pairwise
from pathlib import Path
from typing import Any

from chaos_ledger import Ledger, Row
from chaos_witness import Witness
from dispatch_ledger import leads
from ordeal_lies import Misled
from ordeal_people import is_near
from ordeal_truth import MOMENT_S, SPARE_S, Truth

from mend.dialogue.evidence import Change
from mend.fleet.requests import LegAction
from mend.maps.building.building import Building
from mend.robots.base.behaviors.behavior import MEETS_M
from mend.robots.base.companion import CAUGHT_UP_M
from mend.server.fleets.item_names import item_of
from mend.server.fleets.place_names import PlaceNames
from mend.sim.building.goods import MOST_ITEMS
from mend.tasks.scene import Scene

OVER = ("done", "refused", "cancelled", "failed")
AT_M = MEETS_M + 0.4
BESIDE_M = CAUGHT_UP_M + 0.7
"""Who comes nearer when they were last looked at walks so far until the robot sees them there."""
WITH_PERSON_M = 3.0
BEGINS_S = 60.0
QUOTE = "'"
BRINGS = (LegAction.HAND_OVER, LegAction.GIVE, LegAction.BRING_BACK)
FETCHES = (LegAction.COLLECT, LegAction.TAKE)


@dataclass(frozen=True, slots=True)
class Setting:
    """What was asked of whom: `robots` as the service calls them, `asked` by name."""

    building: Building
    scene: Scene
    robots: Sequence[str]
    capacity: float
    asked: Mapping[str, str]


class OrdealLedger:
    """Judges one site, once its service has stopped."""

    def __init__(self, journal: Path, truth: Truth, setting: Setting, witness: Witness) -> None:
        self._journal, self._truth, self._setting = Ledger(journal), truth, setting
        self._witness = witness
        self._names = PlaceNames(setting.building, setting.scene)
        self._rows = self._journal.rows
        self._what: dict[str, list[Row]] = defaultdict(list)
        self._unnoticed: set[str] = set()
        """What was handed over to somebody else, or something else for it: nobody could know."""
        for row in self._of("request_changed"):
            self._what[row.body["request"]].append(row)
        self._misled = Misled((each.body for each in self._rows), self._was_at)

    def _of(self, *kinds: str) -> list[Row]:
        return [each for each in self._rows if each.kind in kinds]

    def faults(self) -> list[str]:
        """A sentence for whatever is not as it should be."""
        return [
            *self._journal.faults_of_events(self._witness),
            *self._truth.faults,
            *self._touches(),
            *self._runs(),
            *self._felt(),
            *self._doors(),
            *self._requests(),
            *self._legs(),
            *self._loads(),
            *self._ways_of_things(),
            *self._ends_of_things(),
        ]

    def counts(self) -> Counter[str]:
        """How often what was done, and what became of requests."""
        ended = self._of("leg_ended")
        found = Counter(f"leg {row.body['outcome']}" for row in ended)
        found += Counter(f"done {r.body['action']}" for r in ended if r.body["outcome"] == "done")
        found += Counter(f"request {rows[-1].body['status']}" for rows in self._what.values())
        found["errand ended"] = len(self._of("errand_ended"))
        found["question"] = len(
            {r.body["prompt"] for r in self._of("prompt") if r.body["kind"] == "ask"}
        )
        found["event of the journal"] = len(self._rows)
        found["stolen"] = sum(each.what == "stolen" for each in self._truth.kept)
        found["taken by who it was not for"] = sum(
            each.what == "stolen" and each.body["offers"] == each.body["item"]
            for each in self._truth.kept
        )
        found += Counter(
            f"killed {e.body['whom']}" for e in self._truth.lines if e.what == "killed"
        )
        found["carried"] = sum(each.what == "carried" for each in self._truth.kept)
        found["promise not kept"] = sum(bool(e.body.get("lied")) for e in self._truth.kept)
        found["life of the world"] = self._truth.lives
        return found

    # --- Robots and people ----------------------------------------------------------------------

    def _touches(self) -> Iterator[str]:
        """Also in what a kill undid."""
        for line in self._truth.lines:
            if line.what == "touched":
                yield f"{line.t:.1f} s: touched: {line.body['who']} by {line.body['by_m']:.3f} m"
            elif line.what == "drove against something":
                yield f"{line.t:.1f} s: a robot drove against something"

    # --- Runs -----------------------------------------------------------------------------------

    def _runs(self) -> Iterator[str]:
        """A run's clock begins at 0, and no robot refuses what it is told."""
        begun: set[str] = set()
        for row in self._rows:
            if row.kind == "run_started":
                begun.add(row.run)
            elif row.run in begun and row.time > BEGINS_S and row.kind == "robot_holding":
                yield f"the clock of run {row.run} begins at {row.time:.1f} s"
            if row.kind == "node_started":
                begun.discard(row.run)
            if row.kind == "node_reset" and "the robot refused" in row.body["reason"]:
                yield f"event {row.seq}: {row.body['robot']}: {row.body['reason']}"

    # --- What robots say of their baskets -------------------------------------------------------

    def _felt(self) -> Iterator[str]:
        """What a robot says to feel in its basket, since it asked, really was put in or taken."""
        asked: dict[str, datetime] = {}
        for row in self._of("dialogue_opened", "help_verified"):
            dialogue, at = row.body["dialogue"], datetime.fromisoformat(row.body["wall_time"])
            if row.kind == "dialogue_opened":
                asked[dialogue] = at
                continue
            change = row.body["change"]
            if change not in (Change.LOADED, Change.UNLOADED):
                continue
            number = self._setting.robots.index(row.body["robot"])
            span = asked[dialogue].timestamp(), at.timestamp() + MOMENT_S
            steps = pairwise(self._truth.baskets_between(*span, number))
            if not any(
                (now - before if change == Change.LOADED else before - now) for before, now in steps
            ):
                yield f"event {row.seq}: {row.body['robot']} feels its basket {change}: it is not"

    # --- What robots say of doors ---------------------------------------------------------------

    def _doors(self) -> Iterator[str]:
        """A door that is said to be shut was so, and one that is seen open since then was that."""
        raised: dict[str, tuple[str, float]] = {}
        for row in self._of("issue_raised", "help_verified"):
            body = row.body
            if body["issue"] != "door_closed":
                continue
            at_s = datetime.fromisoformat(body["wall_time"]).timestamp()
            if row.kind == "issue_raised":
                detection = body["detection"]
                floor, named = detection["between"][0].split("/")[0], detection["explanation"]
                door = f"{floor}/{named.split(QUOTE)[1]}"
                raised[body["robot"]] = door, at_s
                shut = list(self._truth.shut_between(at_s - MOMENT_S, at_s + MOMENT_S))
                knows = not self._misled.is_misled(body["robot"], at_s)
                if knows and not any(door in each for each in shut):
                    yield f"event {row.seq}: {body['robot']} says that {door} is shut: it is not"
            elif body["change"] == Change.CLEARED:
                door, raised_s = raised[body["robot"]]
                shut = list(self._truth.shut_between(raised_s, at_s + MOMENT_S))
                knows = not self._misled.is_misled(body["robot"], at_s)
                if knows and all(door in each for each in shut):
                    yield f"event {row.seq}: {body['robot']} sees {door} open: it is shut"

    # --- Requests -------------------------------------------------------------------------------

    def _requests(self) -> Iterator[str]:
        for name, how in self._setting.asked.items():
            rows = self._what.get(name, [])
            if not rows:
                if how != "unknown":
                    yield f"'{name}' was {how}, and the journal knows nothing of it"
                continue
            if how == "refused" and rows[0].body["status"] != "refused":
                yield f"'{name}' was refused, and the journal has it as {rows[0].body['status']}"
        for name in self._what.keys() - self._setting.asked.keys():
            yield f"nobody asked for '{name}'"
        for name, rows in self._what.items():
            for before, after in pairwise(row.body for row in rows):
                was, now = before["status"], after["status"]
                if was != now and not leads(was, now):
                    yield f"{after['at_s']:.1f} s: '{name}' was {was} and is {now}"
            last = rows[-1].body
            if last["status"] not in OVER:
                yield f"{last['at_s']:.1f} s: '{name}' waits for ever: {last['status']}"
            if last["status"] in ("refused", "failed") and not last["reason"]:
                yield f"{last['at_s']:.1f} s: '{name}' is {last['status']}, and nobody says why"

    # --- Legs -----------------------------------------------------------------------------------

    def _legs(self) -> Iterator[str]:
        begun: dict[str, Row | None] = {}
        numbers: Counter[str] = Counter()
        for row in self._of("leg_begun", "leg_ended"):
            robot, number = row.body["robot"], row.body["number"]
            who = f"{row.body['at_s']:.1f} s: leg {number} of {robot}"
            under_way = begun.get(robot)
            if row.kind == "leg_begun":
                if under_way is not None:
                    yield f"{who} begins while leg {under_way.body['number']} is under way"
                if number <= numbers[robot] and numbers[robot]:
                    yield f"{who} begins after leg {numbers[robot]}"
                begun[robot], numbers[robot] = row, number
                continue
            if under_way is None or under_way.body["number"] != number:
                yield f"{who} ends, which was not under way"
                continue
            begun[robot] = None
            if "fault of Mend's own" in (row.body["reason"] or ""):
                yield f"{who}: {row.body['reason']}"
            if row.body["outcome"] == "done":
                yield from self._done(who, under_way.body, row.body)
        for robot, left in begun.items():
            if left is not None:
                yield f"leg {left.body['number']} of {robot} never ends"

    def _done(self, who: str, begun: dict[str, Any], ended: dict[str, Any]) -> Iterator[str]:
        """What is said to be done really was so at some moment of the leg."""
        number = self._setting.robots.index(ended["robot"])
        place, action = ended["place"], ended["action"]
        said = f"{who}: {action} '{ended['booking']}' at {place} is said to be done"
        span = begun["at_s"], ended["at_s"]
        states = list(self._truth.states_between(*span))
        if action in FETCHES and self._had(number, begun):
            # What a robot has, it need not go and fetch.
            return
        ended_s = datetime.fromisoformat(ended["wall_time"]).timestamp()
        knows = not self._misled.is_misled(ended["robot"], ended_s)
        came = any(self._away_m(each["robots"][number], place) <= AT_M for each in states)
        if knows and not came:
            nearest = min((self._away_m(e["robots"][number], place) for e in states), default=-1.0)
            yield f"{said}, and its robot was {nearest:.1f} m off"
        what = self._what[ended["booking"]][-1].body["what"]
        if action in (LegAction.MEET, LegAction.ESCORT):
            with_m = math.inf if action == LegAction.MEET else WITH_PERSON_M
            if not any(self._with_person(e, number, what["person"], place, with_m) for e in states):
                yield f"{said}, and {what['person']} was not there with the robot"
        if action in (*FETCHES, *BRINGS):
            item = item_of(what["what"], ended["booking"])
            there_was = list(self._truth.items_between(*span))
            where = [each.get(item) for each in there_was]
            there = self._names.in_scene(place)
            had = any(e and e[1] == number and not e[2] for e in where)
            if action in FETCHES and not had and not _something_else(there_was, number):
                yield f"{said}, and it was never in the basket: {where[-1]}"
            if action in BRINGS and not any(e and e[0] == there for e in where):
                if self._felt_alike(item, span) or _something_else_brought(there_was, number):
                    self._unnoticed.add(ended["booking"])
                else:
                    yield f"{said}, and it is not there: {where[-1]}"

    def _felt_alike(self, item: str, span: tuple[float, float]) -> bool:
        """Whether its robot could not feel in a span that nobody took it for whom it was."""
        begun_s, ended_s = span
        return any(
            begun_s - SPARE_S <= each <= ended_s + SPARE_S
            for each in self._truth.felt_alike_s(item)
        )

    def _had(self, number: int, begun: dict[str, Any]) -> bool:
        """Whether a robot had in its basket already what a leg is to fetch."""
        what = self._what[begun["booking"]][-1].body["what"]
        before = next(self._truth.items_between(begun["at_s"], begun["at_s"]))
        item = before.get(item_of(what["what"], begun["booking"]))
        return item is not None and item[1] == number and not item[2]

    def _was_at(self, robot: str, said: str, at_s: float) -> bool:
        """Whether a robot was at a place, as it is said, at a wall time."""
        at = self._truth.robot_at(self._setting.robots.index(robot), at_s)
        return at is not None and is_near(self._setting.building, self._setting.scene, at, said)

    def _away_m(self, at: Sequence[Any], place: str) -> float:
        pose = self._setting.scene.places[self._names.in_scene(place)].pose
        if at[0] != self._setting.building.floor_at(pose.z or 0.0):
            return math.inf
        return math.hypot(at[1] - pose.x, at[2] - pose.y)

    def _with_person(
        self, state: dict[str, Any], number: int, person: str, place: str, within_m: float
    ) -> bool:
        robot, guest = state["robots"][number], state["guests"].get(str(number))
        if guest is None or guest[0] != person or guest[1] != robot[0]:
            return False
        beside = math.hypot(guest[2] - robot[1], guest[3] - robot[2]) <= BESIDE_M
        return beside and (within_m == math.inf or self._away_m(guest[1:], place) <= within_m)

    # --- Things ---------------------------------------------------------------------------------

    def _load(self, item: str) -> float:
        for name, rows in self._what.items():
            what = rows[-1].body["what"]
            if what["kind"] == "transport" and item_of(what["what"], name) == item:
                return float(what.get("load", 1.0))
        return 0.0

    def _loads(self) -> Iterator[str]:
        for line in self._truth.kept:
            aboard: dict[int, list[str]] = defaultdict(list)
            for name, (_, robot, taken, _, _) in line.body.get("items", {}).items():
                if robot is not None and not taken:
                    aboard[robot].append(name)
            for robot, names in aboard.items():
                load = sum(self._load(each) for each in names)
                if load > self._setting.capacity + 1e-9 or len(names) > MOST_ITEMS:
                    yield f"{line.t:.1f} s: robot {robot} carries {load}: {names}"

    def _ways_of_things(self) -> Iterator[str]:
        """No thing goes, or is where it was brought to twice."""
        before: dict[str, list[Any]] = {}
        brought: Counter[tuple[str, str]] = Counter()
        for line in self._truth.kept:
            now = line.body.get("items")
            if now is None:
                continue
            for name in before.keys() - now.keys():
                yield f"{line.t:.1f} s: '{name}' is nowhere any more"
            for name, (place, _, _, delivered, _) in now.items():
                was = before.get(name)
                if place is not None and delivered and was is not None and was[0] is None:
                    brought[name, place] += 1
            before = now
        for (name, place), times in brought.items():
            if times > 1:
                yield f"'{name}' was brought to {place} {times} times"

    def _ends_of_things(self) -> Iterator[str]:
        items = self._truth.items
        for name, rows in self._what.items():
            last = rows[-1].body
            what, status, reason = last["what"], last["status"], last["reason"] or ""
            if what["kind"] != "transport" or status not in OVER:
                continue
            item = items.get(item_of(what["what"], name))
            said = f"{last['at_s']:.1f} s: '{name}' is {status}"
            if status == "done":
                there = self._names.in_scene(what["destination"])
                brought = item is not None and item[0] == there and item[3]
                if not brought and name not in self._unnoticed:
                    yield f"{said}, and not at {there}: {item}"
            elif item is None or item[0] is not None or item[2]:
                continue
            elif "for a person to take it" not in reason:
                yield f"{said} ({reason}), and is still in the basket of robot {item[1]}"


def _something_else_brought(there_was: list[dict[str, list[Any]]], number: int) -> bool:
    """Whether somebody took out what was put in for the thing that was to be put in."""
    return any(
        name.startswith("something else") and was[1] == number and after[name][1] is None
        for before, after in pairwise(there_was)
        for name, was in before.items()
    )


def _something_else(there_was: list[dict[str, list[Any]]], number: int) -> bool:
    """Whether somebody put another thing into a basket: a load cell does not tell them apart."""
    return any(
        name.startswith("something else") and each[1] == number
        for items in there_was
        for name, each in items.items()
    )
