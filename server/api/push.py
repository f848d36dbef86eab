"""Devices that are called by web push, over REST: which, from now on, no more, and a trial."""

from datetime import datetime
from typing import Annotated

from fastapi import APIRouter, Body, Path, Query
from pydantic import BaseModel, ConfigDict, Field

from mend.documents.spellings import DEVICE, NONCE, SEEN_CHARACTERS
from mend.server.api.problems import documented
from mend.server.api.repeatable import RepeatableRoute
from mend.server.api.services import HelperName, WithCaller, WithServices, helper_of
from mend.server.push.sending import Outcome
from mend.server.push.subscription import DeviceKeys, PushSubscription
from mend.server.push.subscriptions import Device

router = APIRouter(prefix="/api/push", tags=["push"], route_class=RepeatableRoute)

DeviceId = Annotated[str, Path(pattern=DEVICE, description="The id of a push subscription.")]
EXAMPLES = [
    {
        "endpoint": "https://fcm.googleapis.com/fcm/send/one-device",
        "keys": {
            "p256dh": (
                "BGsX0fLhLEJH-Lzm5WOkQPJ3A32BLeszoPShOUXYmMKWT-NC4v4af5uO5-tKfA-e"
                "FivOM1drMV7Oy7ZAaDe_UfU"
            ),
            "auth": "BTBZMqHH6r4Tts7J_aSIgg",
        },
        "device": "Anna's phone",
        "helper": "anna",
    }
]


class PushView(BaseModel):
    """Whether devices can be called. `key`: what a browser is to take as `applicationServerKey`.

    `asked`: whether questions are ever put to the helper who asks.
    """

    model_config = ConfigDict(frozen=True)

    available: bool
    key: str
    asked: bool


class PushKeys(BaseModel):
    """A browser's keys, in base64url."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)

    p256dh: Annotated[str, Field(max_length=200)]
    auth: Annotated[str, Field(max_length=100)]


class NewSubscription(BaseModel):
    """What a browser's `PushSubscription` says, and what the device is called."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)

    endpoint: Annotated[str, Field(min_length=1, max_length=2048)]
    keys: PushKeys
    device: Annotated[str, Field(min_length=1, max_length=64, pattern=SEEN_CHARACTERS)]
    helper: HelperName | None = None


class DeviceView(BaseModel):
    """A device that is called; how it is reached stays between its browser and the service."""

    model_config = ConfigDict(frozen=True)

    id: str
    helper: str
    device: str
    since: datetime


class TrialRequest(BaseModel):
    """What the pushed message is to say, so that the device knows its own."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)

    nonce: Annotated[str, Field(min_length=1, max_length=64, pattern=NONCE)]


class TrialView(BaseModel):
    """What the push service made of a trial; `why` says it where it was not `taken`."""

    model_config = ConfigDict(frozen=True)

    outcome: Outcome
    why: str


@router.get("", operation_id="get_push", responses=documented(401, 421, 422))
async def get_push(
    services: WithServices, caller: WithCaller, helper: Annotated[HelperName | None, Query()] = None
) -> PushView:
    """Whether devices can be called, with which key, and whether this helper is ever asked."""
    name = caller.helper_name(helper)
    push = services.push
    asked = name is not None and push.asks(name)
    return PushView(available=push.available, key=push.application_key, asked=asked)


@router.get(
    "/subscriptions", operation_id="list_push_subscriptions", responses=documented(401, 403, 421)
)
async def list_push_subscriptions(services: WithServices, caller: WithCaller) -> list[DeviceView]:
    """Your devices that are called."""
    return [_view(each) for each in services.push.of(caller)]


@router.post(
    "/subscriptions", operation_id="add_push_subscription", status_code=201,
    responses=documented(400, 401, 403, 409, 413, 421, 422, 503),
)  # fmt: skip
async def add_push_subscription(
    body: Annotated[NewSubscription, Body(examples=EXAMPLES)],
    services: WithServices,
    caller: WithCaller,
) -> DeviceView:
    """Have a device called from now on; one that is called already keeps its id."""
    keys = DeviceKeys(p256dh=body.keys.p256dh, auth=body.keys.auth)
    device = Device(body.endpoint, keys, body.device)
    helper = helper_of(caller, body.helper)
    return _view(await services.push.subscribe(device, helper, caller))


@router.delete(
    "/subscriptions/{device}", operation_id="end_push_subscription", status_code=204,
    responses=documented(401, 403, 404, 421, 422, 503),
)  # fmt: skip
async def end_push_subscription(
    device: DeviceId, services: WithServices, caller: WithCaller
) -> None:
    """Have one of your devices called no more."""
    await services.push.unsubscribe(device, caller)


@router.post(
    "/subscriptions/{device}/trial", operation_id="try_push_subscription",
    responses=documented(400, 401, 403, 404, 413, 421, 422),
)  # fmt: skip
async def try_push_subscription(
    device: DeviceId,
    body: Annotated[TrialRequest, Body(examples=[{"nonce": "a3f81c"}])],
    services: WithServices,
    caller: WithCaller,
) -> TrialView:
    """Push something to one of your devices, to see whether it comes there."""
    answer = await services.push.try_out(device, body.nonce, caller)
    return TrialView(outcome=answer.outcome, why=answer.why)


def _view(subscription: PushSubscription) -> DeviceView:
    return DeviceView(
        id=subscription.id,
        helper=subscription.helper,
        device=subscription.device,
        since=subscription.since,
    )
