"""What the service's process takes over each of its lives: a new one begins small again."""

from dataclasses import dataclass

import psutil


@dataclass(frozen=True, slots=True)
class Footprint:
    """What a process takes: memory in MB, it and its children, its descriptors and threads."""

    rss_mb: float
    processes: int
    descriptors: int
    threads: int


@dataclass(slots=True)
class Life:
    """What one life took once a run had ended in it, None before; and what it took last.

    By then it has everything in memory that it uses, and has taken up the runs of the life before.
    """

    pid: int
    ended_before: int
    began_s: float = 0.0
    first: Footprint | None = None
    last: Footprint | None = None
    lasted_s: float = 0.0

    @property
    def grown_mb(self) -> float:
        if self.first is None or self.last is None:
            return 0.0
        return self.last.rss_mb - self.first.rss_mb


class Lives:
    """The lives of a process that is killed and started again, in order."""

    def __init__(self) -> None:
        self.each: list[Life] = []
        self.most_rss_mb = 0.0

    def note(self, pid: int, footprint: Footprint, ended: int, now_s: float) -> None:
        """This is what it takes now that so many runs have ended; a new `pid` is a new life."""
        self.most_rss_mb = max(self.most_rss_mb, footprint.rss_mb)
        if not self.each or self.each[-1].pid != pid:
            self.each.append(Life(pid, ended))
        life = self.each[-1]
        if life.first is None and ended > life.ended_before:
            life.began_s, life.first = now_s, footprint
        if life.first is not None:
            life.last, life.lasted_s = footprint, now_s - life.began_s

    @property
    def worst(self) -> Life | None:
        """The life that grew by most; None if none was there for long enough."""
        known = [life for life in self.each if life.first is not None]
        return max(known, key=lambda life: life.grown_mb, default=None)


def footprint_of(pid: int) -> Footprint | None:
    """What a process takes now; None if it is not there any more."""
    try:
        process = psutil.Process(pid)
        return Footprint(
            process.memory_info().rss / 1e6,
            1 + len(process.children(recursive=True)),
            process.num_fds(),
            process.num_threads(),
        )
    except psutil.Error:
        return None
