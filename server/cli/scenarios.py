"""`mend scenarios`: the scenarios that come with Mend."""

from server.cli.failures import told_plainly
from server.cli.output import print_rows
from tasks.scenario_file import load_scenario, scenario_names


def scenarios() -> None:
    """List the scenarios that come with Mend, and the task tree that each is for."""
    with told_plainly():
        loaded = [load_scenario(name) for name in scenario_names()]
    print_rows(
        [(each.name, each.tree, " ".join(each.description.split())) for each in loaded],
        ("scenario", "tree", "what happens"),
    )
