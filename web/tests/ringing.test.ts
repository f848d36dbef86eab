// What rings, how often, and until when.
import { describe, expect, it } from "vitest";
import { pauseAfter, Ringer, ringing } from "../src/calling/ringing";

function asked(prompt: string, to: string | null = null, claimed_by: string | null = null, interrupts = true) {
  return { prompt: { prompt, to } as never, claimed_by, interrupts };
}

const keys = (open: Parameters<typeof ringing>[0], putOff: readonly string[] = []) =>
  ringing(open, [], "anna", new Set(putOff)).map(({ key }) => key);

describe("what rings for a helper", () => {
  it("is what they, or anybody, are asked, and nobody is on", () => {
    const open = [asked("all"), asked("anna's", "anna"), asked("bob's", "bob"), asked("taken", null, "bob"), asked("mine", null, "anna")];
    expect(keys(open)).toEqual(["all null", "anna's anna"]);
  });

  it("is not what they have put off here", () => {
    expect(keys([asked("one"), asked("two")], ["one"])).toEqual(["two null"]);
  });

  it("is urgent where the robot does not wait", () => {
    const rings = ringing([asked("one", null, null, false)], [], "anna", new Set());
    expect(rings).toEqual([{ key: "one null", urgent: true }]);
  });

  it("is to hold something for who has said so alone", () => {
    const together = [
      { prompt: "hold", helper: "anna" },
      { prompt: "other", helper: "bob" },
    ];
    expect(ringing([], together, "anna", new Set())).toEqual([{ key: "hold", urgent: true }]);
  });
});

describe("a robot that is gone", () => {
  const lost = [{ robot: "ada", run: "r" }];

  it("calls everybody, and not those who know", () => {
    const [ring] = ringing([], [], "anna", new Set(), lost);
    expect(ring).toEqual({ key: "lost ada r", urgent: false });
    expect(ringing([], [], "anna", new Set(["lost ada r"]), lost)).toEqual([]);
  });
});

class Bench {
  rung: boolean[] = [];
  waits: number[] = [];
  #then: (() => void) | null = null;
  readonly ringer = new Ringer({
    ring: (urgent) => void this.rung.push(urgent),
    later: (ms, then) => {
      this.waits.push(ms);
      this.#then = then;
      return () => {
        if (this.#then === then) this.#then = null;
      };
    },
  });

  get waiting() {
    return this.#then !== null;
  }

  pass(): void {
    const then = this.#then;
    this.#then = null;
    then?.();
  }
}

const calm = { key: "one", urgent: false };

describe("ringing", () => {
  it("begins at once, and comes again after longer and longer, up to a minute", () => {
    const bench = new Bench();
    bench.ringer.set([calm]);
    for (let count = 0; count < 8; count++) bench.pass();
    expect(bench.rung).toHaveLength(9);
    expect(bench.waits).toEqual([6_000, 12_000, 20_000, 30_000, 45_000, 60_000, 60_000, 60_000, 60_000]);
  });

  it("ends when nothing is left", () => {
    const bench = new Bench();
    bench.ringer.set([calm]);
    bench.ringer.set([]);
    expect(bench.waiting).toBe(false);
    bench.pass();
    expect(bench.rung).toEqual([false]);
  });

  it("begins anew with what is new, and not with what goes or stays", () => {
    const bench = new Bench();
    bench.ringer.set([calm, { key: "two", urgent: false }]);
    bench.ringer.set([calm]);
    expect(bench.rung).toEqual([false]);
    bench.ringer.set([calm, { key: "three", urgent: true }]);
    expect(bench.rung).toEqual([false, true]);
    expect(bench.waits.at(-1)).toBe(pauseAfter(1, true));
  });

  it("rings again for what has come back", () => {
    const bench = new Bench();
    bench.ringer.set([calm]);
    bench.ringer.set([]);
    bench.ringer.set([calm]);
    expect(bench.rung).toEqual([false, false]);
  });

  it("is sooner where help is needed now", () => {
    for (let rings = 1; rings < 10; rings++) expect(pauseAfter(rings, true)).toBeLessThan(pauseAfter(rings, false));
  });
});
