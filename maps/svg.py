"""Writing SVG: shapes, texts, and a style for light and dark."""

from xml.sax.saxutils import escape, quoteattr

FONT_PX = 11.0
CHARACTER_PX = 0.62 * FONT_PX
"""How wide a character is at most on average; texts are laid out by this."""

_READABLE = 0.75
"""A drawing may be shown so much smaller."""

COLORS = (
    "#4269d0", "#e0851b", "#3ca951", "#d6483b", "#8d5ad6",
    "#1a9fae", "#d4569a", "#8a7a2f", "#6f8796", "#7aa52c",
)  # fmt: skip

STYLE = """\
svg { --ink: #1c2126; --soft: #69727c; --line: #d9dee3; --paper: #ffffff; --busy: #3b434b;
  background: var(--paper); font: 11px system-ui, sans-serif; }
@media (prefers-color-scheme: dark) {
  svg { --ink: #e8ecf0; --soft: #9aa5b0; --line: #353c44; --paper: #15181c; --busy: #c3ccd5; }
}
text { fill: var(--ink); } .soft { fill: var(--soft); }
.title { font-size: 15px; font-weight: 600; }
.name { font-weight: 600; } .grid { stroke: var(--line); } .busy { fill: var(--busy); }
.wait { fill: var(--line); }
.transfer { fill: var(--paper); stroke: var(--ink); stroke-width: 1.6; }
.handed { stroke: var(--ink); stroke-width: 1.2; stroke-dasharray: 3 3; }
.place { fill: var(--soft); }
.halo { paint-order: stroke; stroke: var(--paper); stroke-width: 3px; }
.middle { text-anchor: middle; } .end { text-anchor: end; }
"""


def color(number: int) -> str:
    """The colour of a robot or item."""
    return COLORS[number % len(COLORS)]


def text_width_px(text: str) -> float:
    """How much room a text needs."""
    return CHARACTER_PX * len(text)


class Svg:
    """A picture as it grows."""

    def __init__(self) -> None:
        self._parts: list[str] = []

    def add(
        self, tag: str, content: str | None = None, tip: str = "", **attributes: str | float
    ) -> None:
        """An element; `class_` is its class, an underscore in a name a hyphen.

        `tip` is what it says when it is pointed at.
        """
        written = "".join(
            f" {name.rstrip('_').replace('_', '-')}={quoteattr(_value(value))}"
            for name, value in attributes.items()
        )
        within = escape(content or "") + (f"<title>{escape(tip)}</title>" if tip else "")
        ending = f">{within}</{tag}>" if within or content is not None else "/>"
        self._parts.append(f"<{tag}{written}{ending}")

    def text(self, x: float, y: float, text: str, class_: str = "") -> None:
        """A text whose baseline begins at a point."""
        self.add("text", text, x=x, y=y, class_=class_)

    def diamond(self, x: float, y: float, radius: float, class_: str) -> None:
        """A square on its corner."""
        self.add(
            "path", d=f"M{x:.1f} {y - radius:.1f}l{radius:.1f} {radius:.1f} {-radius:.1f} "
            f"{radius:.1f} {-radius:.1f} {-radius:.1f}z", class_=class_,
        )  # fmt: skip

    def figure(self, width: float, height: float, title: str, description: str) -> str:
        """A part of a page, which styles it; who cannot see it is read the description.

        On a narrow page it gets smaller until its text could not be read.
        """
        return (
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.0f} {height:.0f}" '
            f'style="min-width:{_READABLE * width:.0f}px" role="img" '
            f"aria-label={quoteattr(f'{title}: {description}')}>\n"
            f"<title>{escape(title)}</title>\n<desc>{escape(description)}</desc>\n"
            + "\n".join(self._parts)
            + "\n</svg>\n"
        )

    def document(self, width: float, height: float, title: str) -> str:
        """The whole file."""
        return (
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.0f} {height:.0f}" '
            f'width="{width:.0f}" height="{height:.0f}" role="img">\n'
            f"<title>{escape(title)}</title>\n<style>\n{STYLE}</style>\n"
            + "\n".join(self._parts)
            + "\n</svg>\n"
        )


def _value(value: str | float) -> str:
    return value if isinstance(value, str) else f"{value:.1f}".removesuffix(".0")
