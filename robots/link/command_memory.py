"""Which commands a robot has carried out, so that it does none of them twice."""

from collections import OrderedDict


class CommandMemory:
    """The last `capacity` command ids of this boot.

    It need not outlive the program: the service never sends a command of an earlier boot again,
    and stops sending one once it is taken.
    """

    def __init__(self, capacity: int = 10_000) -> None:
        self._capacity = capacity
        self._ids: OrderedDict[str, None] = OrderedDict()

    def is_new(self, command_id: str) -> bool:
        """Whether the command comes for the first time; from now on it does not."""
        if command_id in self._ids:
            self._ids.move_to_end(command_id)
            return False
        self._ids[command_id] = None
        if len(self._ids) > self._capacity:
            self._ids.popitem(last=False)
        return True
