"""What all tests share: no property fails for how long it takes, as machines may be busy."""

from hypothesis import settings

settings.register_profile("busy", deadline=None)
settings.load_profile("busy")
