"""The whole service put together: journal, robots, worlds, runtime and API, in one process."""

import asyncio
import logging
import time
from collections.abc import AsyncIterator, Callable
from contextlib import AsyncExitStack, asynccontextmanager, suppress
from dataclasses import dataclass
from datetime import UTC, datetime
from functools import partial

from mend.dialogue.registry import load_scripts
from mend.server.access.access import Access
from mend.server.access.deed_log import DeedLog
from mend.server.api.robot_socket import add_robot_route
from mend.server.app import build_access, create_app
from mend.server.background import Endless
from mend.server.believed_time import BelievedTime
from mend.server.dialogues.attendance import Attendance
from mend.server.dialogues.escalation import EscalationPolicy
from mend.server.dialogues.mail import Mailer
from mend.server.fixed_documents import GivenFiles, fixed_documents
from mend.server.fleets.fleets import Fleets
from mend.server.journal.run_index import RunPage
from mend.server.journal.sqlite import IN_MEMORY, SqliteJournal
from mend.server.library import Library, build_library
from mend.server.listening import listen, reachable_host
from mend.server.models.own_models import OwnModels
from mend.server.models.robot_models import RobotModels, WorldModels
from mend.server.off_loop import OffLoop
from mend.server.poses.feed import PoseFeed
from mend.server.poses.record import PoseRecords
from mend.server.push.push import Push
from mend.server.push.subscriptions import PushSubscriptions
from mend.server.refusals import Refusals
from mend.server.retention import prune_regularly
from mend.server.robots.address import robots_url
from mend.server.robots.passes import OwnRobots
from mend.server.robots.process import launch
from mend.server.robots.registry import RobotRegistry
from mend.server.robots.simulation_thread import SimulationThread
from mend.server.robots.times import LinkTimes
from mend.server.runtime.context import RunSettings
from mend.server.runtime.operator_mail import OperatorMail
from mend.server.runtime.runtime import Runtime
from mend.server.scene_checks import WorldChecks
from mend.server.server_tls import tls_of
from mend.server.serving import Server, serve_config
from mend.server.session_key import session_key
from mend.server.settings import Settings, is_everywhere
from mend.server.sites.sites import Sites
from mend.server.sites.worlds import SimulatedWorlds
from mend.server.speech.abilities import SpeechAbilities
from mend.server.speech.ear import choose_ears
from mend.server.speech.rendering import SpokenTexts, render_prompts
from mend.server.speech.voice import NoVoice, choose_voice
from mend.tasks.plugins import load_plugins

log = logging.getLogger(__name__)

LOOK_EVERY_S = 1.0


@dataclass(frozen=True, slots=True)
class Service:
    """A service that runs; `url` is where this machine reaches it.

    `public_url` is where others do, if that is known.
    """

    runtime: Runtime
    journal: SqliteJournal
    registry: RobotRegistry
    library: Library
    sites: Sites
    fleets: Fleets
    url: str
    public_url: str | None
    settings: Settings
    devices: PushSubscriptions

    @property
    def robots_url(self) -> str:
        """Where this machine's robots connect."""
        return robots_url(self.url)


@asynccontextmanager
async def open_service(
    settings: Settings, *, recover: bool = True, given: GivenFiles | None = None
) -> AsyncIterator[Service]:
    """Start a service, take up the runs that had not ended, and stop it at the end.

    What is in `given` is known as if it came with Mend. Raises `JournalLockedError` when another
    process has the journal, `OSError` when it cannot listen, `WrongSettingsError` when it cannot
    use its certificate. `recover` False leaves unfinished runs alone.
    """
    journal = SqliteJournal(settings.journal_path)
    try:
        async with _open(settings, journal, recover, given or GivenFiles()) as service:
            yield service
    finally:
        journal.close()


@asynccontextmanager
async def _open(
    settings: Settings, journal: SqliteJournal, recover: bool, given: GivenFiles
) -> AsyncIterator[Service]:
    refusals = Refusals()
    deeds = DeedLog(journal, lambda: datetime.now(UTC))
    own_robots = OwnRobots()
    key_path = settings.session_key_path if recover else None
    access = build_access(
        settings,
        deeds,
        session_key=None if key_path is None else session_key(key_path),
        own_robots=own_robots,
        refusals=refusals,
    )
    registry = RobotRegistry(
        journal,
        time.monotonic,
        LinkTimes(
            heartbeat_s=settings.heartbeat_s,
            silence_s=settings.robot_hang_timeout_s,
            absence_s=settings.robot_absence_s,
        ),
        settings.limits,
        refusals,
    )
    adapters = load_plugins("mend.worlds")
    # What runs need later is loaded now: there may be no descriptor left to open it with then.
    for group in ("mend.behaviors", "mend.monitors"):
        load_plugins(group)
    tls = tls_of(settings)
    config_socket = listen(settings)
    url = f"{'https' if tls else 'http'}://{reachable_host(settings.host)}:{config_socket.getsockname()[1]}"
    off_loop = OffLoop(settings.limits)
    simulation_thread = SimulationThread()
    library = build_library(
        journal,
        fixed_documents(given, settings.scenes),
        WorldChecks(adapters),
        settings.limits,
        off_loop,
        utc_now=lambda: datetime.now(UTC),
    )
    models = _models(settings, WorldModels(adapters.values()), journal, off_loop)
    poses = PoseFeed(registry.show_poses, models.drawn, _pose_records(settings))
    models.own.changed = poses.models_changed
    worlds = SimulatedWorlds(adapters)
    sites = Sites(
        worlds,
        journal,
        registry,
        partial(
            launch,
            registry=registry,
            url=robots_url(url),
            own_robots=own_robots,
            aside=simulation_thread,
            certificate=settings.tls_certificate,
            hang_s=settings.robot_hang_timeout_s,
        ),
        own_robots,
        settings.limits,
        library,
        utc_now=lambda: datetime.now(UTC),
    )
    public_url = settings.public_url or (None if is_everywhere(settings.host) else url)
    mail = _operator_mail(settings, public_url)
    attendance = Attendance(time.monotonic, settings.away_after_s)
    runtime = Runtime(
        journal=journal,
        robots=registry,
        worlds=sites,
        preparation=library,
        scripts=load_scripts(),
        policy=_policy(settings),
        send_mail=mail.send_later,
        settings=RunSettings(
            help_window_s=settings.help_window_s,
            person_leaf_s=settings.person_leaf_s,
            max_helped_retries=settings.max_helped_retries,
            max_times_gone=settings.max_times_gone,
            robot_lost_timeout_s=settings.robot_lost_timeout_s,
            robot_silent_timeout_s=settings.robot_silent_timeout_s,
            claim_lease_s=settings.claim_lease_s,
            record_before_fault_s=settings.record_before_fault_s,
            record_after_fault_s=settings.record_after_fault_s,
            recording_period_s=settings.recording_period_s,
            limits=settings.limits,
        ),
        monotonic=time.monotonic,
        utc_now=lambda: datetime.now(UTC),
        poses=poses,
        refusals=refusals,
        attendance=attendance,
    )
    fleets = Fleets(
        sites,
        runtime,
        journal,
        poses,
        utc_now=lambda: datetime.now(UTC),
        most_open=settings.limits.open_requests,
    )
    push = Push(
        journal,
        runtime.dialogues,
        runtime,
        access,
        settings,
        settings.push_key_path if recover else None,
        utc_now=lambda: datetime.now(UTC),
    )
    attendance.called_by_push = push.helpers
    speech = _speech(settings)
    app = create_app(
        runtime,
        journal,
        settings,
        trees=library.trees,
        scenes=library.scenes,
        scenarios=library.scenarios,
        worlds=worlds,
        sites=sites,
        fleets=fleets,
        models=models,
        poses=poses,
        access=access,
        deeds=deeds,
        push=push,
        speech_abilities=speech,
        refusals=refusals,
        off_loop=off_loop,
        attendance=attendance,
    )
    add_robot_route(app, registry, access)
    server = Server(serve_config(app, settings), settings, refusals, tls)
    serving: asyncio.Task[None] | None = None
    pruning: asyncio.Task[None] | None = None
    watching: asyncio.Task[None] | None = None
    rendering = asyncio.create_task(_render_prompts(speech, journal), name="rendering")
    try:
        if recover:
            # Before it listens: a run that is not read yet would be unknown to whoever asks.
            await sites.recover()
            await runtime.recover()
            await fleets.recover()
            await deeds.recover(access.sessions)
            await push.start()
        pruning = asyncio.create_task(
            prune_regularly(
                journal.prune, poses.forget, settings.keep.keep(), await _pruning_time(journal)
            ),
            name="pruning",
        )
        # A service for one run alone does not journal what was done to the principals before.
        watching = asyncio.create_task(_watch_access(access, deeds, journal_changes=recover))
        serving = asyncio.create_task(server.serve(sockets=[config_socket]), name="server")
        await server.wait_until_started(serving)
        yield Service(
            runtime, journal, registry, library, sites, fleets, url, public_url, settings,
            push.subscriptions,
        )  # fmt: skip
    finally:
        # From the last to the first, each of them also where one before has failed.
        async with AsyncExitStack() as ending:
            ending.callback(config_socket.close)
            ending.callback(simulation_thread.close)
            ending.push_async_callback(deeds.close)
            ending.push_async_callback(_stop_serving, server, serving)
            ending.push_async_callback(_stop_speech, speech, rendering)
            ending.callback(poses.shut)
            ending.push_async_callback(mail.close)
            ending.push_async_callback(push.close)
            ending.push_async_callback(_cancel, watching)
            ending.push_async_callback(sites.close)
            ending.push_async_callback(runtime.close)
            ending.push_async_callback(fleets.close)
            ending.push_async_callback(_cancel, pruning)
            # Nobody's end waits for what takes long: who asked for it is told to come again.
            ending.callback(off_loop.close)
            # First: a report that no run takes any more must not be acknowledged.
            ending.callback(registry.close)


async def _pruning_time(journal: SqliteJournal) -> BelievedTime:
    """A clock that is far ahead of the last run may be wrong, and what is pruned is gone."""
    newest = await journal.index.page(RunPage(limit=1))
    since = max((each.ended_at or each.started for each in newest), default=None)
    return BelievedTime(lambda: datetime.now(UTC), time.monotonic, since)


async def _cancel(task: "asyncio.Task[None] | None") -> None:
    if task is not None:
        task.cancel()
        await asyncio.gather(task, return_exceptions=True)


async def _stop_serving(server: Server, serving: "asyncio.Task[None] | None") -> None:
    if serving is not None:
        server.should_exit = True
        with suppress(asyncio.CancelledError):
            await serving


async def _watch_access(access: Access, deeds: DeedLog, *, journal_changes: bool) -> None:
    """Let go of those who may come in no longer, also where nobody asks for anything."""
    looks: list[Callable[[], None]] = [access.let_go, deeds.tell_due]
    if journal_changes:
        looks.append(lambda: deeds.take_changes(access.principals.changes))
    watching = Endless("watching who may come in")
    while True:
        with watching.one_pass():
            await access.look()
        for look in looks:
            with watching.one_pass():
                look()
        await asyncio.sleep(LOOK_EVERY_S)


def _pose_records(settings: Settings) -> PoseRecords | None:
    """Beside the journal; a journal in memory is not there for replay."""
    if not settings.record_poses or str(settings.journal_path) == IN_MEMORY:
        return None
    return PoseRecords(settings.journal_path.with_suffix(".poses"))


def _models(
    settings: Settings, worlds: WorldModels, journal: SqliteJournal, off_loop: OffLoop
) -> RobotModels:
    own = OwnModels(
        settings.models_path,
        journal,
        settings.limits,
        off_loop,
        utc_now=lambda: datetime.now(UTC),
        taken=worlds.__contains__,
    )
    return RobotModels(worlds, own)


def _operator_mail(settings: Settings, public_url: str | None) -> OperatorMail:
    mailer = Mailer(settings.mail) if settings.mail else None
    if mailer is not None and public_url is None:
        log.warning("mails will not say where the console is: set 'public_url'")
    return OperatorMail(mailer, lambda: datetime.now(UTC), public_url)


def _speech(settings: Settings) -> SpeechAbilities:
    voice = choose_voice(
        settings.speech_voice,
        flite_voice=settings.speech_flite_voice,
        piper_model=settings.speech_piper_model,
    )
    texts = voice if isinstance(voice, NoVoice) else SpokenTexts(voice)
    return SpeechAbilities(
        texts,
        choose_ears(
            settings.speech_recognition,
            settings.speech_conversations,
            settings.speech_model,
            settings.speech_language,
        ),
    )


async def _render_prompts(speech: SpeechAbilities, journal: SqliteJournal) -> None:
    if isinstance(speech.texts, SpokenTexts):
        await render_prompts(speech.texts, journal)


async def _stop_speech(speech: SpeechAbilities, rendering: "asyncio.Task[None]") -> None:
    rendering.cancel()
    (ended,) = await asyncio.gather(rendering, return_exceptions=True)
    if isinstance(ended, Exception):
        log.error("prompts were not rendered ahead any more", exc_info=ended)
    await speech.close()


def _policy(settings: Settings) -> EscalationPolicy:
    return EscalationPolicy(
        helpers=tuple(settings.helpers),
        repeats=settings.ask_repeats,
        operators=settings.mail.operators if settings.mail else (),
        answer_within_s=settings.ask_deadline_s,
        mail_answer_within_s=settings.mail_deadline_s,
    )
