"""A typed client of the service, for users, the command line, the demo and tests."""

import asyncio
import contextlib
from collections.abc import AsyncIterator, Awaitable
from datetime import datetime
from types import TracebackType
from typing import TYPE_CHECKING, Any, Literal, Self, TypeVar
from urllib.parse import quote
from uuid import UUID

import httpx
from pydantic import TypeAdapter, ValidationError

from mend.server.api.issues import IssueSummary
from mend.server.api.principals import CodeView, DeedsPage, PrincipalView, TokenView
from mend.server.api.problems import Problem, problem
from mend.server.api.speech import SpeechView
from mend.server.api.statistics import Statistics
from mend.server.client_connection import HelperEndpoint
from mend.server.client_errors import RefusedError, UnreachableError
from mend.server.client_retries import send_once
from mend.server.client_speech import SpeechStream
from mend.server.client_stream import EventStream
from mend.server.documents import (
    DocumentCheck,
    DocumentSummary,
    DocumentView,
    KeptDocument,
    ScenarioSummary,
    SceneSummary,
)
from mend.server.fleets.asking import AskedRobotView, UnderstoodView, WordsAsked
from mend.server.fleets.operator_requests import WayReport
from mend.server.fleets.views import FleetView, RequestView
from mend.server.journal.events import (
    Answered,
    AnyEvent,
    DeadlineExtended,
    Event,
    HelpReported,
    PromiseTakenBack,
    RunAborted,
    RunFailed,
    RunFinished,
)
from mend.server.journal.trouble import Sleep
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.views import (
    ChosenView,
    DialogueView,
    LeafSaid,
    QuestionBatchView,
    RobotView,
    RunSummary,
    RunView,
    Snapshot,
)
from mend.server.sites.requests import SiteRequest
from mend.server.sites.views import SiteView
from mend.tasks.intervention import Intervention

if TYPE_CHECKING:
    from mend.fleet.dispatch.booking import AnyRequest

T = TypeVar("T")

DEFAULT_URL = "http://127.0.0.1:8080"
READY_PAUSE_S = 0.1

IDLE_S = 2.0
"""An idle connection is let go after so long: a request on one that the service is just closing
would be lost."""

ENDS = (RunFinished, RunFailed, RunAborted)

_events: TypeAdapter[Any] = TypeAdapter(list[AnyEvent])


class MendClient:
    """Talks to one service; an asynchronous context manager.

    Every method raises `RefusedError` or `UnreachableError`. What changes something is sent under
    an idempotency key, and sent again where a connection was lost before the answer had come.
    """

    def __init__(
        self,
        url: str = DEFAULT_URL,
        *,
        token: str | None = None,
        timeout_s: float = 30.0,
        sleep: Sleep = asyncio.sleep,
    ) -> None:
        self._sleep = sleep
        self._url = url.rstrip("/")
        self._headers = {"Authorization": f"Bearer {token}"} if token else {}
        self._http = httpx.AsyncClient(
            base_url=self._url,
            headers=self._headers,
            timeout=timeout_s,
            # Without TLS there is nobody to verify: reading all authorities would take for nothing.
            verify=not self._url.lower().startswith("http:"),
            limits=httpx.Limits(keepalive_expiry=IDLE_S),
        )

    async def __aenter__(self) -> Self:
        return self

    async def __aexit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        await self._http.aclose()

    # --- trees, scenes and scenarios ----------------------------------------------------------

    async def trees(self) -> list[DocumentSummary]:
        return await self._get("/api/trees", list[DocumentSummary])

    async def tree(self, name: str) -> DocumentView:
        return await self._get(f"/api/trees/{name}", DocumentView)

    async def upload_tree(self, text: str, name: str | None = None) -> KeptDocument:
        """Keep a task file (YAML or JSON); replaces an uploaded one of the same name."""
        return await self._upload("/api/trees", text, name)

    async def check_tree(self, text: str) -> DocumentCheck:
        """Find the mistakes of a task file, and what keeps a world's robot from doing it."""
        return await self._post("/api/trees/check", DocumentCheck, {"text": text})

    async def delete_tree(self, name: str) -> None:
        await self._request("DELETE", f"/api/trees/{name}")

    async def scenes(self) -> list[SceneSummary]:
        return await self._get("/api/scenes", list[SceneSummary])

    async def scene(self, name: str) -> DocumentView:
        return await self._get(f"/api/scenes/{name}", DocumentView)

    async def upload_scene(self, text: str, name: str | None = None) -> KeptDocument:
        """Keep a scene file (YAML or JSON); replaces an uploaded one of the same name."""
        return await self._upload("/api/scenes", text, name)

    async def check_scene(self, text: str) -> DocumentCheck:
        """Find the mistakes of a scene file, and what keeps a world's robot from doing it."""
        return await self._post("/api/scenes/check", DocumentCheck, {"text": text})

    async def delete_scene(self, name: str) -> None:
        await self._request("DELETE", f"/api/scenes/{name}")

    async def scenarios(self) -> list[ScenarioSummary]:
        return await self._get("/api/scenarios", list[ScenarioSummary])

    async def scenario(self, name: str) -> DocumentView:
        return await self._get(f"/api/scenarios/{name}", DocumentView)

    async def upload_scenario(self, text: str, name: str | None = None) -> KeptDocument:
        """Keep a scenario file (YAML or JSON); replaces an uploaded one of the same name."""
        return await self._upload("/api/scenarios", text, name)

    async def check_scenario(self, text: str) -> DocumentCheck:
        """Find the mistakes of a scenario file, and what keeps a world's robot from doing it."""
        return await self._post("/api/scenarios/check", DocumentCheck, {"text": text})

    async def delete_scenario(self, name: str) -> None:
        await self._request("DELETE", f"/api/scenarios/{name}")

    async def _upload(self, path: str, text: str, name: str | None) -> KeptDocument:
        body = {"text": text} if name is None else {"text": text, "name": name}
        return await self._post(path, KeptDocument, body)

    # --- runs ---------------------------------------------------------------------------------

    async def start_run(self, request: RunRequest) -> RunSummary:
        return await self._post("/api/runs", RunSummary, request.model_dump(mode="json"))

    async def runs(
        self, *, limit: int = 100, offset: int = 0, before: UUID | None = None
    ) -> list[RunSummary]:
        """Runs, newest first; only those that began before another, for the next page."""
        last = None if before is None else str(before)
        return await self._get(
            "/api/runs", list[RunSummary], limit=limit, offset=offset, before=last
        )

    async def issues(
        self,
        *,
        text: str | None = None,
        since: datetime | None = None,
        until: datetime | None = None,
        before: int | None = None,
        limit: int = 100,
    ) -> list[IssueSummary]:
        """Issues of all runs, newest first; those before a `seq`, for the next page.

        `text` is contained in what the issue, its part, place, robot, leaf or tree is called.
        """
        moments = {"since": since, "until": until}
        return await self._get(
            "/api/issues",
            list[IssueSummary],
            text=text,
            before=before,
            limit=limit,
            **{name: each.isoformat() for name, each in moments.items() if each is not None},
        )

    async def statistics(
        self,
        *,
        since: datetime | None = None,
        until: datetime | None = None,
        tree: str | None = None,
        robot: str | None = None,
    ) -> Statistics:
        """How often what went wrong in the runs that began in a span, of a tree or a robot."""
        moments = {"since": since, "until": until}
        return await self._get(
            "/api/statistics",
            Statistics,
            tree=tree,
            robot=robot,
            **{name: each.isoformat() for name, each in moments.items() if each is not None},
        )

    async def run_report(self, run: UUID) -> bytes:
        """The report of a run, so far, as HTML."""
        return (await self._request("GET", f"/api/runs/{run}/report")).content

    async def run_export(self, run: UUID, form: Literal["csv", "mcap"]) -> bytes:
        """A run so far as a file for other programs."""
        return (await self._request("GET", f"/api/runs/{run}/export?format={form}")).content

    async def run(self, run: UUID) -> RunView:
        return await self._get(f"/api/runs/{run}", RunView)

    async def pause(self, run: UUID) -> RunSummary:
        return await self._post(f"/api/runs/{run}/pause", RunSummary)

    async def resume(self, run: UUID) -> RunSummary:
        return await self._post(f"/api/runs/{run}/resume", RunSummary)

    async def abort(self, run: UUID) -> RunSummary:
        return await self._post(f"/api/runs/{run}/abort", RunSummary)

    async def events(self, run: UUID, *, after: int = 0, limit: int = 100) -> list[Event]:
        """A page of a run's events with `seq` > `after`, in order; only the last one is empty."""
        response = await self._request(
            "GET", f"/api/runs/{run}/events", params={"after": after, "limit": limit}
        )
        events: list[Event] = _events.validate_json(response.content)
        return events

    async def camera(self, run: UUID, camera: str) -> bytes:
        """What a camera sees now, as JPEG."""
        return (await self._request("GET", f"/api/runs/{run}/cameras/{camera}")).content

    async def take_leaf(self, run: UUID, node: str, helper: str) -> RunSummary:
        """Have a leaf be a person's, who does it themselves; a robot that sees it done says so."""
        body = {"node": node, "helper": helper}
        return await self._post(f"/api/runs/{run}/leaves/take", RunSummary, body)

    async def give_leaf_back(self, run: UUID, node: str, helper: str) -> RunSummary:
        """Have it be anybody's again."""
        body = {"node": node, "helper": helper}
        return await self._post(f"/api/runs/{run}/leaves/give_back", RunSummary, body)

    async def say_of_leaf(self, run: UUID, words: str, helper: str) -> LeafSaid:
        """Either of these in plain words: "I do the saucer", "I give the saucer back"."""
        body = {"words": words, "helper": helper}
        return await self._post(f"/api/runs/{run}/leaves/say", LeafSaid, body)

    async def intervene(self, run: UUID, intervention: Intervention) -> Intervention:
        """Have a person do something in a simulated world."""
        body = intervention.model_dump(mode="json")
        return await self._post(f"/api/runs/{run}/interventions", Intervention, body)

    async def wait_for_end(self, run: UUID) -> RunView:
        """Follow the events until a run has ended."""
        async with self.follow("waiting") as stream:
            async for message in stream:
                if isinstance(message, Snapshot) or (
                    isinstance(message, ENDS) and message.run == run
                ):
                    view = await self.run(run)
                    if view.status.ended:
                        return view
        raise AssertionError("a stream has no end of its own")

    # --- dialogues ----------------------------------------------------------------------------

    async def dialogues(
        self, status: Literal["open", "closed"] | None = None
    ) -> list[DialogueView]:
        return await self._get("/api/dialogues", list[DialogueView], status=status)

    async def questions(self) -> list[QuestionBatchView]:
        """The open questions, the most urgent first; those that may be answered alike together."""
        return await self._get("/api/questions", list[QuestionBatchView])

    async def choose_for_all(self, way: str, prompts: list[UUID], helper: str) -> list[ChosenView]:
        """Choose one of a batch's `at_once` for its questions; what became of each."""
        body = {"way": way, "prompts": [str(each) for each in prompts], "helper": helper}
        return await self._post("/api/questions/choices", list[ChosenView], body)

    async def dialogue(self, dialogue: UUID) -> DialogueView:
        return await self._get(f"/api/dialogues/{dialogue}", DialogueView)

    async def answer(
        self, dialogue: UUID, prompt: UUID, answer: Literal["yes", "no"], helper: str
    ) -> Answered:
        """Answer a prompt. A `RefusedError` has `problem.answered_by` if another was first."""
        body = {"prompt": str(prompt), "answer": answer, "helper": helper}
        return await self._post(f"/api/dialogues/{dialogue}/answers", Answered, body)

    async def choose(self, dialogue: UUID, prompt: UUID, way: str, helper: str) -> Answered:
        """Choose one of a prompt's `ways`; the last of its answers. Raises as `answer` does."""
        body = {"prompt": str(prompt), "way": way, "helper": helper}
        return await self._post(f"/api/dialogues/{dialogue}/choices", Answered, body)

    async def extend(self, dialogue: UUID, prompt: UUID, helper: str) -> DeadlineExtended:
        """Give the open question as much time again as it was first put for."""
        path = f"/api/dialogues/{dialogue}/extend"
        return await self._post(path, DeadlineExtended, {"prompt": str(prompt), "helper": helper})

    async def said_done(self, dialogue: UUID, helper: str) -> HelpReported:
        """Say that the awaited help is done: the robot looks at once, and says what it sees."""
        path = f"/api/dialogues/{dialogue}/done"
        return await self._post(path, HelpReported, {"helper": helper})

    async def take_back(self, dialogue: UUID, helper: str) -> PromiseTakenBack:
        """Take back the promise to help: the dialogue goes on as after a no to it."""
        path = f"/api/dialogues/{dialogue}/take_back"
        return await self._post(path, PromiseTakenBack, {"helper": helper})

    async def claim(self, dialogue: UUID, helper: str, *, take_over: bool = False) -> DialogueView:
        path = f"/api/dialogues/{dialogue}/claim"
        body = {"helper": helper, "take_over": take_over}
        return await self._post(path, DialogueView, body)

    async def release(self, dialogue: UUID, helper: str) -> DialogueView:
        path = f"/api/dialogues/{dialogue}/release"
        return await self._post(path, DialogueView, {"helper": helper})

    async def picture(self, picture: UUID) -> bytes:
        """The picture that an event names, as JPEG."""
        return (await self._request("GET", f"/api/pictures/{picture}")).content

    # --- sites --------------------------------------------------------------------------------

    async def open_site(self, request: SiteRequest) -> SiteView:
        """Start a simulated world that stays, with its robots, for runs to come."""
        return await self._post("/api/sites", SiteView, request.model_dump(mode="json"))

    async def sites(self) -> list[SiteView]:
        return await self._get("/api/sites", list[SiteView])

    async def site(self, site: UUID) -> SiteView:
        return await self._get(f"/api/sites/{site}", SiteView)

    async def close_site(self, site: UUID) -> None:
        """Stop a site's world for good; no run may be using it."""
        await self._request("DELETE", f"/api/sites/{site}")

    # --- requests -----------------------------------------------------------------------------

    async def make_request(self, request: "AnyRequest", site: UUID | None = None) -> RequestView:
        """Ask robots of a building for something; `site` says whose, where several take requests.

        Refused with status 409 is what they cannot do in time.
        """
        path = _at_site("/api/requests", site)
        return await self._post(path, RequestView, request.model_dump(mode="json"))

    async def requests(self, site: UUID | None = None) -> list[RequestView]:
        return await self._get(_at_site("/api/requests", site), list[RequestView])

    async def request(self, name: str, site: UUID | None = None) -> RequestView:
        return await self._get(_at_site(f"/api/requests/{name}", site), RequestView)

    async def change_request(
        self, name: str, request: "AnyRequest", site: UUID | None = None
    ) -> RequestView:
        """Ask for something else instead; refused, or once a robot has set out, all stays."""
        path = _at_site(f"/api/requests/{name}", site)
        sent = await self._request("PUT", path, json=request.model_dump(mode="json"))
        return RequestView.model_validate_json(sent.content)

    async def understand_request(
        self, asked: WordsAsked, site: UUID | None = None
    ) -> UnderstoodView:
        """What somebody asks for in words, as a request to be made once they have confirmed it."""
        path = _at_site("/api/requests/understand", site)
        return await self._post(path, UnderstoodView, asked.model_dump(mode="json"))

    async def asked_robot(self, site: UUID, robot: str) -> AskedRobotView:
        """Where a robot of a fleet is, and what it may be asked for."""
        return await self._get(
            f"/api/sites/{site}/fleet/robots/{quote(robot)}/asking", AskedRobotView
        )

    async def cancel_request(self, name: str, site: UUID | None = None) -> None:
        """Want it no more; what is fetched goes back to where it came from."""
        await self._request("DELETE", _at_site(f"/api/requests/{name}", site))

    async def fleet(self, site: UUID) -> FleetView:
        """What the robots of a site are still to do, and why."""
        return await self._get(f"/api/sites/{site}/fleet", FleetView)

    async def take_robot_out(self, site: UUID, robot: str, reason: str) -> None:
        """Have a robot of a fleet do nothing more for now; others fetch what it has."""
        path = f"/api/sites/{site}/fleet/robots/{quote(robot)}/out_of_service"
        await self._request("POST", path, json={"reason": reason})

    async def put_robot_back(self, site: UUID, robot: str) -> None:
        """Have it work again, from where it stands."""
        await self._request(
            "POST", f"/api/sites/{site}/fleet/robots/{quote(robot)}/back_in_service"
        )

    async def send_robot(self, site: UUID, robot: str, place: str) -> None:
        """Have a robot that carries out no leg go to a place, as `FLOOR/PLACE`."""
        path = f"/api/sites/{site}/fleet/robots/{quote(robot)}/go"
        await self._request("POST", path, json={"place": place})

    async def tell_of_way(self, site: UUID, way: WayReport) -> None:
        """Say that a way is blocked, a door closed, or open again."""
        path = f"/api/sites/{site}/fleet/ways"
        await self._request("POST", path, json=way.model_dump(mode="json"))

    # --- robots -------------------------------------------------------------------------------

    async def robots(self) -> list[RobotView]:
        return await self._get("/api/robots", list[RobotView])

    # --- access: for admins -------------------------------------------------------------------

    async def principals(self) -> list[PrincipalView]:
        return await self._get("/api/access/principals", list[PrincipalView])

    async def add_principal(
        self,
        name: str,
        role: Literal["viewer", "helper", "operator", "admin"],
        *,
        expires_days: float | None = None,
    ) -> TokenView:
        """Add a principal and get its token, which is shown only now."""
        body = {"name": name, "role": role, "expires_days": expires_days}
        return await self._post("/api/access/principals", TokenView, body)

    async def rotate_principal(self, name: str, *, expires_days: float | None = None) -> TokenView:
        """Give a principal a new token; the old one and its sessions end."""
        path = f"/api/access/principals/{quote(name, safe='')}/rotate"
        return await self._post(path, TokenView, {"expires_days": expires_days})

    async def revoke_principal(self, name: str) -> None:
        """End a principal: its token, its sessions and its connections."""
        await self._request("DELETE", f"/api/access/principals/{quote(name, safe='')}")

    async def open_enrolment(self, robot: str, *, minutes: float = 15) -> CodeView:
        """Make a code with which a robot fetches its own credential, once."""
        body = {"robot": robot, "minutes": minutes}
        return await self._post("/api/access/enrolments", CodeView, body)

    async def deeds(self, after: int = 0, limit: int = 100, who: str | None = None) -> DeedsPage:
        """Who did what, when, and from where."""
        path = "/api/access/deeds"
        return await self._get(path, DeedsPage, after=after, limit=limit, who=who)

    # --- speech -------------------------------------------------------------------------------

    async def speech(self) -> SpeechView:
        """What the service can say and hear."""
        return await self._get("/api/speech", SpeechView)

    async def sound(self, address: str) -> bytes:
        """What a `say` message names, as a WAV file."""
        return (await self._request("GET", address)).content

    @contextlib.asynccontextmanager
    async def talk(self, helper: str) -> AsyncIterator[SpeechStream]:
        """A microphone, to answer questions by voice."""
        # Sound does not get smaller by deflating it, only later.
        door = HelperEndpoint(self._url, "/ws/speech", self._headers, helper)
        async with door.connected(compression=None) as socket:
            yield SpeechStream(socket)

    # --- events as they come ------------------------------------------------------------------

    def follow(self, helper: str, after: int | None = None) -> EventStream:
        """Follow every event from now on, or from the one after `after`, as a helper."""
        return EventStream(HelperEndpoint(self._url, "/ws/helper", self._headers, helper), after)

    async def wait_until_ready(self, timeout_s: float = 30.0) -> None:
        """Wait until the service can be used. Raises `UnreachableError` after the time-out."""
        try:
            async with asyncio.timeout(timeout_s):
                while True:
                    if await self._ready():
                        return
                    await asyncio.sleep(READY_PAUSE_S)
        except TimeoutError:
            raise UnreachableError(
                f"no service is ready at {self._url} after {timeout_s:g} s"
            ) from None

    async def _ready(self) -> bool:
        try:
            await self._request("GET", "/readyz")
        except (UnreachableError, RefusedError):
            return False
        return True

    # --- the wire -----------------------------------------------------------------------------

    async def _get(self, path: str, shape: type[T], **parameters: Any) -> T:
        given = {name: value for name, value in parameters.items() if value is not None}
        response = await self._request("GET", path, params=given)
        return TypeAdapter(shape).validate_json(response.content)

    async def _post(self, path: str, shape: type[T], body: Any = None) -> T:
        response = await self._answer(
            send_once(
                lambda headers: self._http.post(path, json=body, headers=headers), self._sleep
            )
        )
        return TypeAdapter(shape).validate_json(response.content)

    async def _request(self, method: str, path: str, **more: Any) -> httpx.Response:
        return await self._answer(self._http.request(method, path, **more))

    async def _answer(self, sent: Awaitable[httpx.Response]) -> httpx.Response:
        try:
            response = await sent
        except httpx.HTTPError as error:
            raise UnreachableError(f"no service answers at {self._url}: {error}") from error
        if response.is_error:
            raise RefusedError(_problem_in(response))
        return response


def _at_site(path: str, site: UUID | None) -> str:
    return path if site is None else f"{path}?site={site}"


def _problem_in(response: httpx.Response) -> Problem:
    try:
        return Problem.model_validate_json(response.content)
    except ValidationError:
        return problem(response.status_code, response.text[:200] or "the service said no more")
