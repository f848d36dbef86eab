"""`mend scenarios`: the scenarios that come with Mend."""

from mend.server.cli.failures import told_plainly
from mend.server.cli.rows import print_rows


def scenarios() -> None:
    """List the scenarios that come with Mend, and the task tree that each is for."""
    from mend.tasks.library import SCENARIOS
    from mend.tasks.scenario_file import built_in_scenario

    with told_plainly():
        loaded = [built_in_scenario(name) for name in SCENARIOS.names()]
    print_rows(
        [(each.name, each.tree, " ".join(each.description.split())) for each in loaded],
        ("scenario", "tree", "what happens"),
    )
