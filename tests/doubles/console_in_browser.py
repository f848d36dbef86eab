"""What tests of the console share: the service's token, and how a page is opened."""

from collections.abc import Awaitable, Callable

from playwright.async_api import Page

TOKEN = "correct-horse-battery"

OpenPage = Callable[..., Awaitable[Page]]
"""`await open_page(path, helper=name, **context_options)`: a helper who has signed in."""
