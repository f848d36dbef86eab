// Whether somebody is at this page, as far as a page can tell: who is not is asked after those who are.

/** As the service hears it: somebody has just done something here, nobody sees this page, or it always listens. */
export type Presence = "active" | "away" | "beside";

/** Where a page stands that is at nobody's desk. */
export type Stand = "beside_robot" | "before_robot" | null;

/** Says what became of it, a clock in ms, and a timer; passed in, so that no test waits. */
export interface Watch {
  tell(presence: Presence): void;
  now(): number;
  later(ms: number, then: () => void): () => void;
}

/** So long nobody is told again that somebody is still active. */
export const AGAIN_MS = 15_000;

export class AtPage {
  #shown: boolean;
  #acted = true;
  #stand: Stand = null;
  #told: Presence;
  #toldAt: number;
  #awayAfterMs = 300_000;
  #stop: () => void = () => undefined;

  /** Who opens a page is at it, unless it was opened where nobody sees it. */
  constructor(
    private readonly watch: Watch,
    shown: boolean,
  ) {
    this.#shown = shown;
    this.#told = this.presence;
    this.#toldAt = watch.now();
    this.#wait();
  }

  get presence(): Presence {
    // Who stands before a robot sees no question here.
    if (this.#stand === "before_robot") return "away";
    if (this.#stand === "beside_robot") return "beside";
    return this.#shown && this.#acted ? "active" : "away";
  }

  /** Somebody has done something here, or was heard. */
  acted(): void {
    this.#acted = true;
    if (this.presence === "active" && (this.#told !== "active" || this.watch.now() - this.#toldAt >= AGAIN_MS)) this.#tell();
  }

  /** Whoever brings a page up again is at it. */
  shows(shown: boolean): void {
    this.#shown = shown;
    if (shown) this.acted();
    this.#changed();
  }

  stands(stand: Stand): void {
    this.#stand = stand;
    this.#changed();
  }

  /** After how many seconds the service takes it that nobody is here. */
  awayAfter(seconds: number): void {
    this.#awayAfterMs = seconds * 1000;
    this.#wait();
  }

  #changed(): void {
    if (this.presence !== this.#told) this.#tell();
  }

  #tell(): void {
    this.#told = this.presence;
    this.#toldAt = this.watch.now();
    this.#wait();
    this.watch.tell(this.#told);
  }

  #wait(): void {
    this.#stop();
    if (this.#told !== "active") return;
    this.#stop = this.watch.later(this.#toldAt + this.#awayAfterMs - this.watch.now(), () => {
      this.#acted = false;
      this.#changed();
    });
  }
}
