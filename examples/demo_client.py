# ruff: noqa: T201
"""Have a service run a scenario, and print the transcript as it happens.

Start a service first (`mend serve`); give its token in MEND_TOKEN if it has one. Exits with 0 only
if the task was finished, with 1 if it was not, with 2 if the service could not be used.
"""

import argparse
import asyncio
import os
import sys
from collections import Counter

from mend.server.cli.output import LiveTranscript
from mend.server.client import DEFAULT_URL, ENDS, MendClient
from mend.server.client_errors import ClientError
from mend.server.journal.events import IssueRaised, Resolved
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.views import RunStatus, Snapshot

FINISHED, NOT_FINISHED, UNUSABLE = 0, 1, 2


async def follow_run(client: MendClient, request: RunRequest) -> RunStatus:
    """Start a run and tell its events until it has ended."""
    transcript = LiveTranscript()
    issues: Counter[str] = Counter()
    resolutions: Counter[str] = Counter()
    async with client.follow(helper="demo") as stream:
        messages = aiter(stream)
        # Once the first snapshot is here, no event of the run can be missed.
        await anext(messages)
        run = await client.start_run(request)
        async for event in messages:
            if isinstance(event, Snapshot) or event.run != run.id:
                continue
            transcript.show(event)
            if isinstance(event, IssueRaised):
                issues[event.issue] += 1
            elif isinstance(event, Resolved):
                resolutions[event.resolution] += 1
            elif isinstance(event, ENDS):
                break
    transcript.close()
    print("issues:", ", ".join(f"{count} {issue}" for issue, count in issues.items()) or "none")
    print(
        "resolutions:",
        ", ".join(f"{count} {resolution}" for resolution, count in resolutions.items()) or "none",
    )
    return (await client.run(run.id)).status


async def main(arguments: argparse.Namespace) -> int:
    """Run the scenario, and say how it ended by the exit code."""
    request = RunRequest(
        tree=arguments.tree,
        world=arguments.world,
        scenario=arguments.scenario,
        speed="max",
        seed=arguments.seed,
    )
    try:
        async with (
            asyncio.timeout(arguments.timeout_s),
            MendClient(arguments.url, token=os.environ.get("MEND_TOKEN")) as client,
        ):
            await client.wait_until_ready()
            status = await follow_run(client, request)
    except ClientError as error:
        print(f"demo: {error}", file=sys.stderr)
        return UNUSABLE
    except TimeoutError:
        print(f"demo: the run did not end within {arguments.timeout_s:g} s", file=sys.stderr)
        return NOT_FINISHED
    print(f"the service says that the run has {status}")
    return FINISHED if status is RunStatus.FINISHED else NOT_FINISHED


def read_arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("url", nargs="?", default=DEFAULT_URL, help="default: %(default)s")
    parser.add_argument("--tree", default="eket", help="default: %(default)s")
    parser.add_argument("--world", default="workcell", help="default: %(default)s")
    parser.add_argument("--scenario", default="eket_paper", help="default: %(default)s")
    parser.add_argument("--seed", type=int, default=7, help="default: %(default)s")
    parser.add_argument("--timeout-s", type=float, default=600.0, help="default: %(default)s")
    return parser.parse_args()


if __name__ == "__main__":
    raise SystemExit(asyncio.run(main(read_arguments())))
