"""The application: every route, and the gate before them."""

import asyncio
import time
from collections.abc import AsyncIterator, Callable
from contextlib import AbstractAsyncContextManager, asynccontextmanager
from importlib.metadata import version
from typing import Any

from fastapi import FastAPI

from mend.server.access.access import Access
from mend.server.access.deed_log import DeedLog
from mend.server.access.known_principals import KnownPrincipals
from mend.server.api import behaviors as behaviors_api
from mend.server.api import (
    console,
    dialogues,
    documents,
    health,
    helper_socket,
    helpers,
    issues,
    leaves,
    live_socket,
    metrics,
    pictures,
    questions,
    recordings,
    reference,
    robots,
    run_export,
    run_report,
    runs,
    session,
    speech,
    speech_socket,
    statistics,
    steering,
)
from mend.server.api import fleet as fleet_api
from mend.server.api import models as models_api
from mend.server.api import poses as poses_api
from mend.server.api import principals as principals_api
from mend.server.api import push as push_api
from mend.server.api import requests as requests_api
from mend.server.api import sites as sites_api
from mend.server.api import worlds as worlds_api
from mend.server.api.absolute_form import AbsoluteForm
from mend.server.api.gate import Gate
from mend.server.api.idempotency_key import take_keys
from mend.server.api.openapi_links import add_links
from mend.server.api.openapi_responses import document_answers
from mend.server.api.problem import Problem
from mend.server.api.problems import answer_errors_with_problems
from mend.server.api.repeats import Repeats
from mend.server.api.services import ObservedJournal, Services, WorldList
from mend.server.dialogues.attendance import Attendance
from mend.server.documents import DocumentLibrary
from mend.server.fleets.fleets import Fleets
from mend.server.models.robot_models import RobotModels
from mend.server.off_loop import OffLoop
from mend.server.pace import Sleep
from mend.server.poses.feed import PoseSource
from mend.server.public_url import host_of
from mend.server.push.push import Push
from mend.server.refusals import Refusals
from mend.server.robots.passes import OwnRobots
from mend.server.runtime.service import RunService
from mend.server.settings import Settings
from mend.server.sites.sites import Sites
from mend.server.speech.abilities import NO_SPEECH, SpeechAbilities

ROUTES = (
    session,
    principals_api,
    documents,
    behaviors_api,
    worlds_api,
    sites_api,
    requests_api,
    fleet_api,
    runs,
    run_report,
    run_export,
    issues,
    statistics,
    leaves,
    steering,
    recordings,
    poses_api,
    dialogues,
    questions,
    helpers,
    push_api,
    robots,
    pictures,
    models_api,
    health,
    metrics,
    helper_socket,
    live_socket,
    reference,
    speech,
    speech_socket,
    console,
)

Lifespan = Callable[[], AbstractAsyncContextManager[None]]

DESCRIPTION = "Runs robots through task trees, and asks a person for help when they fail."


def create_app(
    service: RunService,
    journal: ObservedJournal,
    settings: Settings,
    *,
    trees: DocumentLibrary,
    scenes: DocumentLibrary,
    scenarios: DocumentLibrary,
    worlds: WorldList,
    sites: Sites,
    fleets: Fleets,
    models: RobotModels,
    poses: PoseSource,
    access: Access,
    deeds: DeedLog,
    push: Push,
    speech_abilities: SpeechAbilities = NO_SPEECH,
    refusals: Refusals | None = None,
    off_loop: OffLoop | None = None,
    lifespan: Lifespan | None = None,
    wall_time_s: Callable[[], float] = time.time,
    attendance: Attendance | None = None,
) -> FastAPI:
    """Build the application around a runtime and a journal.

    `lifespan` is entered before the first request and left after the last.
    `refusals` are those that `access` counts too.
    """
    app = described_app(lifespan)
    refusals = refusals or Refusals()
    app.state.services = Services(
        service,
        journal,
        trees,
        scenes,
        scenarios,
        worlds,
        sites,
        fleets,
        models,
        poses,
        settings,
        access,
        deeds,
        push,
        Repeats(journal, settings.limits, refusals, wall_time_s),
        speech_abilities,
        refusals,
        off_loop or OffLoop(settings.limits),
        wall_time_s,
        attendance or Attendance(),
    )
    app.add_middleware(Gate, access=access, limits=settings.limits, refusals=refusals)
    app.add_middleware(AbsoluteForm)
    return app


def build_access(
    settings: Settings,
    deeds: DeedLog,
    *,
    session_key: bytes | None = None,
    own_robots: OwnRobots | None = None,
    refusals: Refusals | None = None,
    wall_time_s: Callable[[], float] = time.time,
    now: Callable[[], float] = time.monotonic,
    sleep: Sleep = asyncio.sleep,
) -> Access:
    """Who may come in, as the settings and the file of principals say.

    Without a `session_key` sessions end with the service. Raises `PrincipalsFileError`.
    """
    return Access(
        settings.token.get_secret_value() if settings.token else None,
        principals=KnownPrincipals(
            settings.principals_path, wall_time_s, expected=settings.principals is not None
        ),
        session_key=session_key,
        own_robots=own_robots,
        failed=deeds.failed,
        allowed_hosts=_names(settings),
        allowed_origins=settings.allowed_origins,
        limits=settings.limits,
        refusals=refusals,
        wall_time_s=wall_time_s,
        now=now,
        sleep=sleep,
    )


def described_app(lifespan: Lifespan | None = None) -> FastAPI:
    """The application with its routes, but nothing behind them; enough to describe it."""
    app = FastAPI(
        title="Mend",
        version=version("mend-robots"),
        description=DESCRIPTION,
        lifespan=_entered(lifespan),
        docs_url=None,  # see mend.server.api.reference
        redoc_url=None,
    )
    for module in ROUTES:
        # Each is whole in its module; `include_router` would make every one of them once more.
        app.router.routes.extend(module.router.routes)
    answer_errors_with_problems(app, console.page_of_nothing)
    _describe(app)
    return app


def _names(settings: Settings) -> list[str]:
    """Every name under which clients may reach the service."""
    public = [host_of(settings.public_url)] if settings.public_url else []
    return [settings.host, *public, *settings.allowed_hosts]


def _entered(
    lifespan: Lifespan | None,
) -> Callable[[FastAPI], AbstractAsyncContextManager[None]] | None:
    if lifespan is None:
        return None

    @asynccontextmanager
    async def entered(_app: FastAPI) -> AsyncIterator[None]:
        async with lifespan():
            yield

    return entered


def _describe(app: FastAPI) -> None:
    """Add to the OpenAPI what the routes do not say themselves: the token and the problems."""
    generate = app.openapi

    def openapi() -> dict[str, Any]:
        if app.openapi_schema is None:
            schema = generate()
            components = schema.setdefault("components", {})
            components.setdefault("schemas", {})["Problem"] = Problem.model_json_schema()
            components["securitySchemes"] = {
                "token": {"type": "http", "scheme": "bearer"},
                "session": {"type": "apiKey", "in": "cookie", "name": "mend_session"},
            }
            schema["security"] = [{"token": []}, {"session": []}, {}]
            take_keys(schema)
            document_answers(schema)
            add_links(schema)
        assert app.openapi_schema is not None, "generating it keeps it"
        return app.openapi_schema

    app.openapi = openapi  # type: ignore[method-assign]
