"""Text of robots and people as one line that no terminal and no log takes for anything else."""


def plain(text: str) -> str:
    """The text with its control characters spelt out."""
    if text.isprintable():
        return text
    return "".join(
        each if each.isprintable() else each.encode("unicode_escape").decode() for each in text
    )
