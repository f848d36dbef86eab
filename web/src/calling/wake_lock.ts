// Keeps the screen of a device on that stands beside a robot, while the page is before somebody's eyes.

export type Awake = "held" | "refused" | "absent";

/** Hold the screen on until the function that is returned is called; `tell` hears how that goes. */
export function keepAwake(tell: (awake: Awake) => void): () => void {
  let lock: WakeLockSentinel | null = null;
  let over = false;
  const hold = async () => {
    if (over || document.visibilityState !== "visible") return;
    if (!("wakeLock" in navigator)) {
      tell("absent");
      return;
    }
    try {
      lock = await navigator.wakeLock.request("screen");
      if (over) void lock.release();
      else tell("held");
    } catch {
      // With little battery left, for example.
      tell("refused");
    }
  };
  // The browser lets go of it whenever the page is hidden.
  document.addEventListener("visibilitychange", hold);
  void hold();
  return () => {
    over = true;
    document.removeEventListener("visibilitychange", hold);
    void lock?.release();
  };
}

/** Whether the screen can be kept on here, by doing it for a moment. */
export function tryToKeepAwake(): Promise<Awake> {
  return new Promise((resolve) => {
    const stop = keepAwake((awake) => {
      resolve(awake);
      stop();
    });
  });
}
