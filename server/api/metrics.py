"""What Prometheus may know: runs, dialogues, events, subscribers, limits, the journal's commits."""

from collections.abc import Iterator, Mapping

from fastapi import APIRouter, Response
from prometheus_client import CONTENT_TYPE_LATEST, CollectorRegistry, generate_latest
from prometheus_client.core import CounterMetricFamily, GaugeMetricFamily, HistogramMetricFamily
from prometheus_client.metrics_core import Metric
from prometheus_client.registry import Collector

from mend.server.api.problems import documented
from mend.server.api.services import Services, WithServices
from mend.server.runtime.views import RunStatus

router = APIRouter(tags=["health"])


class ServiceCollector(Collector):
    """Reads the figures where they are, when they are asked for."""

    def __init__(self, services: Services, runs: Mapping[RunStatus, int]) -> None:
        self._services = services
        self._run_counts = runs

    def collect(self) -> Iterator[Metric]:
        runs = GaugeMetricFamily("mend_runs", "Runs by status.", labels=["status"])
        for status, count in self._run_counts.items():
            runs.add_metric([status.value], count)
        yield runs
        yield GaugeMetricFamily(
            "mend_unreadable_runs",
            "Runs that cannot be read from the journal.",
            value=self._run_counts.get(RunStatus.UNREADABLE, 0),
        )
        yield GaugeMetricFamily(
            "mend_unreadable_events",
            "Events that belong to no run and could not be read when the service started.",
            value=len(self._services.deeds.unreadable),
        )
        yield GaugeMetricFamily(
            "mend_open_dialogues",
            "Open dialogues.",
            value=self._services.runs.dialogues.count_open(),
        )
        connected = sum(robot.connected for robot in self._services.runs.robots())
        yield GaugeMetricFamily("mend_robots_connected", "Robots connected.", value=connected)
        yield CounterMetricFamily(
            "mend_pose_frames_lost",
            "Frames of poses that were not recorded, as the disk was too slow for them.",
            value=self._services.poses.lost,
        )
        yield self._refused()
        yield from self._journal()

    def _refused(self) -> Metric:
        refused = CounterMetricFamily(
            "mend_refused",
            "What was beyond a limit, and so refused, ended or forgotten.",
            labels=["limit"],
        )
        for limit, count in self._services.refusals.counts.items():
            refused.add_metric([limit], count)
        return refused

    def _journal(self) -> Iterator[Metric]:
        journal = self._services.journal
        yield CounterMetricFamily("mend_events", "Events in the journal.", value=journal.head)
        subscribers = journal.subscribers
        yield GaugeMetricFamily(
            "mend_subscribers", "Clients that follow the journal.", value=len(subscribers)
        )
        yield CounterMetricFamily(
            "mend_subscribers_cut_off",
            "Clients cut off because they were too slow.",
            value=subscribers.overflows,
        )
        commits = journal.commit_statistics()
        yield CounterMetricFamily(
            "mend_journal_failures", "Commits that failed.", value=commits.failures
        )
        yield GaugeMetricFamily(
            "mend_journal_writable",
            "Whether the journal can be written.",
            value=journal.trouble.reason is None,
        )
        yield GaugeMetricFamily(
            "mend_journal_damage",
            "Places where the journal was found to be damaged when it was opened.",
            value=len(journal.damage),
        )
        yield HistogramMetricFamily(
            "mend_journal_commit_seconds",
            "How long a durable commit took.",
            buckets=[(str(limit), count) for limit, count in commits.buckets]
            + [("+Inf", commits.commits)],
            sum_value=commits.seconds,
        )


@router.get(
    "/metrics",
    operation_id="metrics",
    response_class=Response,
    responses={
        200: {"content": {"text/plain": {}}, "description": "Prometheus' text format."},
        **documented(401, 421),
    },
)
async def metrics(services: WithServices) -> Response:
    """The service's figures for Prometheus."""
    registry = CollectorRegistry(auto_describe=False)
    runs = await services.runs.count_runs()
    registry.register(ServiceCollector(services, runs))
    return Response(generate_latest(registry), media_type=CONTENT_TYPE_LATEST)
