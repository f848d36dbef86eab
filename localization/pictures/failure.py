"""What goes wrong with a picture."""


class PictureError(Exception):
    """A picture that cannot be written; one sentence."""
