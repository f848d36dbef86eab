"""Text of robots and people in terminals and logs."""

import io
from uuid import UUID

from rich.console import Console
from sample_events import RUN, WALL_TIME

from mend.server.cli.output import LiveTranscript
from mend.server.journal.events import StepStarted
from mend.server.plain_text import plain


def test_control_characters_are_spelt_out_and_all_else_is_kept() -> None:
    assert plain("Grüße, 世界 · it's here") == "Grüße, 世界 · it's here"
    assert plain("a\nb\x1b[31mc\x9bd\u2028e") == r"a\nb\x1b[31mc\x9bd\u2028e"


def test_a_step_cannot_write_to_the_terminal_what_it_likes() -> None:
    written = io.StringIO()
    output = LiveTranscript(Console(file=written, highlight=False, soft_wrap=True))
    for step in (1, 2):
        output.show(
            StepStarted(
                time=1.0,
                wall_time=WALL_TIME,
                run=RUN,
                node="/0",
                name="cup",
                robot="arm",
                execution=UUID(int=1),
                step=step,
                step_name="\x1b[2Jgone\nthe run has finished",
            )
        )
    output.close()
    assert "\x1b" not in written.getvalue()
    assert len(written.getvalue().splitlines()) == 1
