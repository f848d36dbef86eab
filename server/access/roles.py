"""The roles that a principal may have, and which of them may do what another may."""

from enum import StrEnum


class Role(StrEnum):
    """What a principal may do: a viewer least, an admin everything; a robot only be that robot."""

    VIEWER = "viewer"
    HELPER = "helper"
    OPERATOR = "operator"
    ADMIN = "admin"
    ROBOT = "robot"

    def may(self, needed: "Role") -> bool:
        """Whether this role may do what needs another."""
        if Role.ROBOT in (self, needed):
            return self is needed
        return PEOPLE.index(self) >= PEOPLE.index(needed)


PEOPLE = (Role.VIEWER, Role.HELPER, Role.OPERATOR, Role.ADMIN)
"""The roles of people, each of which may do what those before it may."""


def with_article(role: Role) -> str:
    """A role in a sentence."""
    return f"an {role}" if role in (Role.OPERATOR, Role.ADMIN) else f"a {role}"
