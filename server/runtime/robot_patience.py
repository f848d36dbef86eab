"""Robots of a run that nothing more is to be hoped for: silent ones, and those in a livelock."""

from mend.server.runtime.context import RunContext
from mend.server.runtime.hardware import Hardware
from mend.server.runtime.presence import RobotPresence
from mend.server.runtime.robot_proxy import RobotActivity, RobotProxy


class RobotPatience:
    """Gives robots of one run up, once it has been patient with them for long enough."""

    def __init__(self, context: RunContext, hardware: Hardware, presence: RobotPresence) -> None:
        self._context, self._hardware, self._presence = context, hardware, presence

    def silent_too_long_at(self, proxy: RobotProxy) -> float | None:
        """When a robot has said nothing for too long of what it was told (the run's clock).

        A simulated one is watched by its process, and its world's clock stands still without it.
        """
        if self._hardware.simulated or not proxy.owes_a_report:
            return None
        if proxy.silent_since is None:
            proxy.silent_since = self._context.clock.now()
        return proxy.silent_since + self._context.settings.robot_silent_timeout_s

    async def gave_up_in_livelock(self, proxy: RobotProxy, *, asks: bool) -> bool:
        """Give an idle robot up if nothing ever comes of what it is told; whether it did.

        `asks`: whether it has people asked about something.
        """
        proxy.livelock.see(
            self._context.state.progress, self._context.clock.now() if asks else None
        )
        idle = (proxy.free or proxy.interruptible) and not proxy.gone_for_good
        if not idle or not proxy.livelock.lasts:
            return False
        await self._presence.give_up_in_livelock(proxy)
        return True

    async def gave_up_as_silent(self, proxy: RobotProxy) -> bool:
        """Give a robot up that says nothing of what it was told; whether it did.

        Of one that was given up before nobody waits any longer to hear that its arm rests.
        """
        due = self.silent_too_long_at(proxy)
        if due is None or self._context.clock.now() < due:
            return False
        if proxy.gone_for_good:
            proxy.doing = RobotActivity.IDLE
            return True
        timeout_s = self._context.settings.robot_silent_timeout_s
        await self._presence.give_up(
            proxy, f"is given up: for {timeout_s:g} s it has said nothing of what it was told"
        )
        return True
