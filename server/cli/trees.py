"""stopgap"""


def trees() -> None: ...
