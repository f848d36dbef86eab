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
    """What one life took at first, with its runs taken up, and what it took last."""

    pid: int
    began_s: float
    first: Footprint
    last: Footprint
    lasted_s: float = 0.0

    @property
    def grown_mb(self) -> float:
        return self.last.rss_mb - self.first.rss_mb


class Lives:
    """The lives of a process that is killed and started again, in order."""

    def __init__(self) -> None:
        self.each: list[Life] = []
        self.most_rss_mb = 0.0

    def forget(self) -> None:
        """What was noted so far does not count."""
        self.each.clear()

    def note(self, pid: int, footprint: Footprint, now_s: float) -> None:
        """This is what it takes now; that of a new `pid` is the first of a life."""
        self.most_rss_mb = max(self.most_rss_mb, footprint.rss_mb)
        if not self.each or self.each[-1].pid != pid:
            self.each.append(Life(pid, now_s, footprint, footprint))
        life = self.each[-1]
        life.last, life.lasted_s = footprint, now_s - life.began_s

    @property
    def worst(self) -> Life | None:
        """The life that grew by most."""
        return max(self.each, key=lambda life: life.grown_mb, default=None)


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
