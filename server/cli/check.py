"""stopgap"""


def check(file: str) -> None: ...
