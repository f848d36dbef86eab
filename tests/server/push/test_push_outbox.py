"""Pushes go over real HTTP, in order, again where need be, and never to a device that is gone."""

import asyncio
from collections.abc import AsyncIterator, Iterator
from datetime import UTC, datetime
from uuid import UUID, uuid4

import pytest
from push_endpoint import PushDevice, PushService, push_service, signed_claims
from smtp_inbox import Watched, listening

from mend.server.push.messages import CallMessage, WithdrawnMessage
from mend.server.push.outbox import Letter, Outbox
from mend.server.push.push_key import push_key
from mend.server.push.sending import PushSender
from mend.server.push.subscription import DeviceKeys, PushSubscription, id_of

KEY = push_key(None)
DIALOGUE, RUN = uuid4(), uuid4()


class Bench:
    """An outbox on the push service of a test, whose clock stands unless it waits."""

    def __init__(self) -> None:
        self.sender = PushSender(KEY, "ops@example.org", timeout_s=5.0)
        self.gone: list[str] = []
        self.waits: list[float] = []
        self.now = 100.0
        self.outbox = Outbox(
            self.sender, lambda each: self.gone.append(each.device), lambda: self.now, self._sleep
        )

    async def _sleep(self, seconds: float) -> None:
        self.waits.append(seconds)
        self.now += seconds

    def put(
        self,
        device: PushDevice,
        message: CallMessage | WithdrawnMessage,
        within_s: float = 60.0,
    ) -> None:
        letter = Letter(message.dialogue.hex, message, self.now + within_s)
        self.outbox.put(subscribed(device), letter)


def subscribed(device: PushDevice) -> PushSubscription:
    said = device.subscription
    return PushSubscription(
        id=id_of(device.endpoint),
        helper="anna",
        principal="anna",
        key="k",
        device=device.name,
        since=datetime(2026, 5, 4, tzinfo=UTC),
        endpoint=device.endpoint,
        keys=DeviceKeys.model_validate(said["keys"]),
        application_key=KEY.public,
    )


def call(text: str = "May I go on?", dialogue: UUID = DIALOGUE) -> CallMessage:
    return CallMessage(dialogue=dialogue, run=RUN, robot="pr2", text=text)


def withdrawn(text: str = "ben answered yes.") -> WithdrawnMessage:
    return WithdrawnMessage(dialogue=DIALOGUE, robot="pr2", text=text)


@pytest.fixture
def service() -> Iterator[PushService]:
    with push_service() as service:
        yield service


@pytest.fixture
async def bench() -> AsyncIterator[Bench]:
    bench = Bench()
    yield bench
    await bench.outbox.close()
    await bench.sender.close()


async def test_only_the_device_can_read_it_and_the_push_service_knows_whose_it_is(
    service: PushService, bench: Bench
) -> None:
    phone, other = PushDevice(service, "phone"), PushDevice(service, "other")
    bench.put(phone, call("Ist es da, wo „X“ war? 🤖"), within_s=29.5)
    await bench.outbox.sent()
    assert service.of(phone) == [call("Ist es da, wo „X“ war? 🤖")]
    [pushed] = service.pushed
    assert b"Ist es da" not in pushed.body
    with pytest.raises(Exception, match=r"^$"):  # InvalidTag says nothing
        other.read(pushed)
    claims = signed_claims(pushed, KEY.public)
    assert claims["sub"] == "mailto:ops@example.org"
    assert pushed.headers["ttl"] == "30"
    assert (pushed.headers["topic"], pushed.headers["urgency"]) == (DIALOGUE.hex, "high")


async def test_what_has_not_left_yet_is_replaced_by_what_is_newer(
    service: PushService, bench: Bench
) -> None:
    phone, another = PushDevice(service, "phone"), uuid4()
    bench.put(phone, call("One?"))
    bench.put(phone, call("Two?", another))
    bench.put(phone, withdrawn())
    await bench.outbox.sent()
    assert service.of(phone) == [call("Two?", another), withdrawn()]


async def test_a_push_service_that_has_no_time_is_asked_again_as_it_says(
    service: PushService, bench: Bench
) -> None:
    phone = PushDevice(service, "phone")
    service.statuses[phone.path] = [429, 503]
    service.retry_after = "7"
    bench.put(phone, call())
    await bench.outbox.sent()
    assert bench.waits == [7.0, 7.0]
    assert service.of(phone) == [call()] * 3
    assert [each.headers["ttl"] for each in service.pushed] == ["60", "53", "46"]


async def test_nobody_is_called_about_what_is_over(
    service: PushService, bench: Bench, caplog: pytest.LogCaptureFixture
) -> None:
    phone = PushDevice(service, "phone")
    service.statuses[phone.path] = [503] * 9
    bench.put(phone, call(), within_s=3.0)
    await bench.outbox.sent()
    assert bench.waits == [1.0, 4.0]
    assert len(service.pushed) == 2
    assert "came too late" in caplog.messages[-1]


@pytest.mark.parametrize("status", [404, 410])
async def test_a_device_that_is_gone_gets_nothing_more(
    service: PushService, bench: Bench, status: int
) -> None:
    phone, tablet = PushDevice(service, "phone"), PushDevice(service, "tablet")
    service.statuses[phone.path] = [status]
    bench.put(phone, call())
    bench.put(phone, call("Another?", uuid4()))
    bench.put(tablet, call())
    await bench.outbox.sent()
    assert bench.gone == ["phone"]
    assert len([each for each in service.pushed if each.path == phone.path]) == 1
    assert service.of(tablet) == [call()]


async def test_what_is_refused_for_good_is_told_in_the_log_alone(
    service: PushService, bench: Bench, caplog: pytest.LogCaptureFixture
) -> None:
    phone = PushDevice(service, "phone")
    service.statuses[phone.path] = [403]
    bench.put(phone, call())
    await bench.outbox.sent()
    assert (bench.gone, bench.waits) == ([], [])
    assert "phone of anna was not called: the push service answered 403" in caplog.messages[-1]
    assert "/to/phone" not in caplog.text


async def test_a_silent_push_service_keeps_neither_others_nor_the_end_waiting(
    service: PushService, bench: Bench
) -> None:
    async with listening(Watched) as port:
        silent = PushService(f"http://127.0.0.1:{port}")
        bench.put(PushDevice(silent, "phone"), call())
        tablet = PushDevice(service, "tablet")
        bench.put(tablet, call())
        async with asyncio.timeout(30):
            while not service.pushed:  # noqa: ASYNC110 - the service is in a thread
                await asyncio.sleep(0.01)
            await bench.outbox.close()
    assert service.of(tablet) == [call()]


async def test_a_push_service_that_is_not_there_is_tried_until_it_is_too_late(
    bench: Bench, caplog: pytest.LogCaptureFixture
) -> None:
    bench.put(PushDevice(PushService("http://127.0.0.1:9"), "phone"), call(), within_s=1000.0)
    await bench.outbox.sent()
    assert bench.waits == [1.0, 4.0, 15.0, 60.0]
    assert "the push service was not reached" in caplog.messages[-1]
