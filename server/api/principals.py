"""Principals and deeds over REST, for admins."""

import re
from collections.abc import Callable
from typing import Annotated, Literal, TypeVar
from uuid import uuid4

from fastapi import APIRouter, Path, Query
from pydantic import BaseModel, ConfigDict, Field
from starlette.concurrency import run_in_threadpool

from mend.server.access.changes import PrincipalsEditor
from mend.server.access.deeds import DEEDS, Deed, deed_of
from mend.server.access.principals_file import PrincipalName, RobotName
from mend.server.access.roles import Role
from mend.server.access.tokens import LONGEST_DAYS
from mend.server.access.views import CodeView, DeedsPage, PrincipalView, TokenView
from mend.server.api.problems import ProblemError, documented
from mend.server.api.repeatable import SecretRoute
from mend.server.api.services import After, Limit, Services, WithCaller, WithServices
from mend.server.journal.events import Author
from mend.server.journal.journal import JournalReadError, JournalWriteError
from mend.server.journal.subscriptions import Record
from mend.server.runtime.journaled_tree import read_without_tree

router = APIRouter(prefix="/api/access", tags=["access"], route_class=SecretRoute)

SCANNED_AT_ONCE = 1000
MOST_SCANNED = 20_000
"""So many events are looked through for one page of deeds."""

Name = Annotated[str, Path(min_length=1, max_length=128, examples=["anna"])]
Days = Annotated[float, Field(gt=0, le=LONGEST_DAYS, allow_inf_nan=False)]
TYPE = re.compile(r'"type":"(\w+)"')
"""Where an event's JSON says of which type it is."""

CHANGES = documented(400, 401, 403, 404, 409, 413, 421, 422, 503)

Done = TypeVar("Done")


class Strict(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)


class NewPrincipal(Strict):
    """Whom to add; without `expires_days` the token lasts until it is revoked."""

    name: PrincipalName = Field(examples=["anna"])
    role: Literal["viewer", "helper", "operator", "admin"]
    expires_days: Days | None = None


class Rotation(Strict):
    """How long the new token lasts; unless said as long as the old one did."""

    expires_days: Days | None = None


class NewEnrolment(Strict):
    """Which robot may fetch its credential, and for how long it may."""

    robot: RobotName = Field(examples=["arm-1"])
    minutes: Annotated[float, Field(gt=0, le=7 * 24 * 60, allow_inf_nan=False)] = 15


@router.get("/principals", operation_id="list_principals", responses=documented(401, 403, 421))
async def list_principals(services: WithServices) -> list[PrincipalView]:
    """Every principal and robot that has a token of its own."""
    now = services.utc_now()
    return [
        PrincipalView(
            name=each.name,
            role=each.role,
            added=each.added,
            expires=each.expires,
            valid=each.valid(now),
        )
        for each in services.access.principals.all()
    ]


@router.post("/principals", operation_id="add_principal", status_code=201, responses=CHANGES)
async def add_principal(
    body: NewPrincipal, services: WithServices, caller: WithCaller
) -> TokenView:
    """Add a principal, and get its token: it is shown only now."""
    role, days = Role(body.role), body.expires_days
    token = await edited(
        services,
        caller.author,
        lambda editor: editor.add(body.name, role, services.utc_now(), days),
    )
    return TokenView(name=body.name, token=token)


@router.post("/principals/{name}/rotate", operation_id="rotate_principal", responses=CHANGES)
async def rotate_principal(
    name: Name, body: Rotation, services: WithServices, caller: WithCaller
) -> TokenView:
    """Give a principal a new token; the old one and its sessions end."""
    token = await edited(
        services,
        caller.author,
        lambda editor: editor.rotate(name, services.utc_now(), body.expires_days),
    )
    return TokenView(name=name, token=token)


@router.delete(
    "/principals/{name}", operation_id="revoke_principal", status_code=204, responses=CHANGES
)
async def revoke_principal(name: Name, services: WithServices, caller: WithCaller) -> None:
    """End a principal: its token, its sessions and its connections.

    That is also done where it cannot be journaled now, and then answered with 503.
    """
    await _edited(services, caller.author, lambda editor: editor.revoke(name, services.utc_now()))


@router.post("/enrolments", operation_id="open_enrolment", status_code=201, responses=CHANGES)
async def open_enrolment(
    body: NewEnrolment, services: WithServices, caller: WithCaller
) -> CodeView:
    """Make a code with which a robot fetches its own credential, once."""
    code = await edited(
        services,
        caller.author,
        lambda editor: editor.open_enrolment(body.robot, services.utc_now(), body.minutes),
    )
    return CodeView(robot=body.robot, code=code)


@router.get("/deeds", operation_id="list_deeds", responses=documented(401, 403, 421, 422))
async def list_deeds(
    services: WithServices,
    after: After = 0,
    limit: Limit = 100,
    who: Annotated[str | None, Query(max_length=128, description="Only this one's.")] = None,
) -> DeedsPage:
    """Who did what, when, and from where; go on with `seq` as `after` while there is `more`.

    A deed that may not be what was committed says so in `damaged`.
    """
    deeds: list[Deed] = []
    last = after
    while last - after < MOST_SCANNED:
        page = await _page_of_deeds(services, last)
        for last, deed in page:
            if deed is not None and who in (None, deed.who):
                deeds.append(deed)
            if len(deeds) == limit:
                return await _deeds_page(services, deeds, last)
        if not page:
            break
    return await _deeds_page(services, deeds, last)


async def edited(
    services: Services, author: Author, change: Callable[[PrincipalsEditor], Done]
) -> Done:
    """Make one change to the file, on behalf of somebody; returns once it is journaled.

    Raises `JournalWriteError`: nothing is changed where it is known that it cannot be journaled.
    """
    if services.journal.trouble.reason is not None:
        raise JournalWriteError(services.journal.trouble.reason)
    return await _edited(services, author, change)


async def _edited(
    services: Services, author: Author, change: Callable[[PrincipalsEditor], Done]
) -> Done:
    """Change the file beside the event loop, know at once what is new in it, and journal it."""
    path, change_id = services.settings.principals_path, uuid4()
    editor = PrincipalsEditor(path, author.principal, author.role, author.address, change_id)
    with services.deeds.changing(change_id):
        try:
            done = await run_in_threadpool(change, editor)
        except OSError as error:
            why = error.strerror or str(error)
            raise ProblemError(503, f"the file of principals cannot be written: {why}") from error
        await services.access.look()
    for made in editor.made:
        await services.deeds.access_changed(made, author)
    return done


async def _deeds_page(services: Services, deeds: list[Deed], last: int) -> DeedsPage:
    """The deeds as the journal's chain has them; it is looked at where they are alone."""
    more = last < services.journal.head
    seals = await services.journal.seals([each.seq for each in deeds])
    return DeedsPage(
        deeds=[each.sealed(seals.get(each.seq)) for each in deeds], seq=last, more=more
    )


async def _page_of_deeds(services: Services, after: int) -> list[tuple[int, Deed | None]]:
    """The next events, each with the deed that it tells of."""
    try:
        records = await services.journal.read_records(after, SCANNED_AT_ONCE)
        return [(each.seq, await _deed(each)) for each in records]
    except JournalReadError:
        # One that cannot be read is told in its place, and takes no other with it.
        events = await services.journal.read_readable(after, SCANNED_AT_ONCE)
        return [(each.seq, deed_of(each)) for each in events]


async def _deed(record: Record) -> Deed | None:
    # Most events are no deeds, and their type is found without reading all of them.
    kind = TYPE.search(record.text)
    if kind is not None and kind.group(1) not in DEEDS:
        return None
    return deed_of(await read_without_tree(record))
