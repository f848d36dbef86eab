"""A transcriber that writes what a test tells it, whatever it hears."""


class Writing:
    """Implements `Transcriber`; `sound` is all that it was given last."""

    def __init__(self, text: str) -> None:
        self._text = text
        self.sound = b""

    def text_of(self, sound: bytes) -> str:
        self.sound = sound
        return self._text
