// What timeline and transcript make of the recorded run of the paper's scenario.
import { beforeAll, describe, expect, it } from "vitest";
import { joined, type Line, linesOf } from "../src/run/transcript_lines";
import { lanesOf, ticksOf } from "../src/run/timeline/lanes";
import type { Told } from "../src/wire/told";
import { foldedRuns } from "./folded_runs.mjs";

let events: Told[] = [];

beforeAll(() => {
  events = foldedRuns([])[0]?.events ?? [];
}, 600_000);

const of = (type: Told["type"]) => events.filter((event) => event.type === type);

describe("lanes", () => {
  it("hold every start, fault, dialogue, deed and resolution once", () => {
    const lanes = lanesOf(events, 100);
    const counts = Object.fromEntries(lanes.map((lane) => [lane.kind, lane.items.length]));
    expect(counts).toEqual({
      steps: of("node_started").length,
      faults: of("issue_raised").length,
      dialogues: of("dialogue_opened").length,
      people: of("intervention").length,
      resolutions: of("resolved").length,
    });
  });

  it("end what has ended when it did, and what goes on now", () => {
    const whole = lanesOf(events, 100);
    const end = events.at(-1)?.time ?? 0;
    for (const item of whole.flatMap((lane) => lane.items)) expect(item.end).toBeLessThanOrEqual(end);
    const opened = events.findIndex((event) => event.type === "dialogue_opened");
    const cut = lanesOf(events.slice(0, opened + 1), 50);
    expect(cut.find((lane) => lane.kind === "dialogues")?.items.at(-1)?.end).toBe(50);
  });

  it("have one for lost robots where one was, each until it is back or the run is over", () => {
    const [begun] = events;
    const at = (type: "robot_lost" | "robot_back" | "run_failed", time: number) =>
      ({ ...begun, type, time, seq: 1000 + time, robot: "pr2-1", reason: "no word", boot: "b", continues: true, node: null }) as unknown as Told;
    const lost = (more: readonly Told[]) =>
      lanesOf([...events.slice(0, 1), ...more], 50).find(({ kind }) => kind === "lost")?.items.map(({ start, end }) => [start, end]);
    expect(lost([])).toBeUndefined();
    expect(lost([at("robot_lost", 3)])).toEqual([[3, 50]]);
    expect(lost([at("robot_lost", 3), at("robot_back", 8), at("robot_lost", 9), at("run_failed", 20)])).toEqual([
      [3, 8],
      [9, 20],
    ]);
  });

  it("put one step after the other", () => {
    for (const item of lanesOf(events, 100)[0]?.items ?? []) {
      for (const [index, step] of item.parts.slice(1).entries()) {
        expect(step.start).toBe(item.parts[index]?.end);
      }
    }
  });
});

describe("ticks", () => {
  it.each([
    [0, 74.1, 8],
    [12.3, 13.3, 5],
    [0, 4200, 10],
  ])("from %d to %d s are at most %d, or one more, and within", (from, to, most) => {
    const ticks = ticksOf(from, to, most);
    expect(ticks.length).toBeGreaterThan(1);
    expect(ticks.length).toBeLessThanOrEqual(most + 1);
    for (const tick of ticks) expect(tick >= from && tick <= to).toBe(true);
  });

  it("are whole minutes where seconds would be too many", () => {
    expect(ticksOf(0, 600, 10)).toEqual([0, 60, 120, 180, 240, 300, 360, 420, 480, 540, 600]);
    expect(ticksOf(50, 130, 5)).toEqual([60, 80, 100, 120]);
  });
});

describe("transcript", () => {
  it("tells what was said, asked and answered word for word and in order", () => {
    const told = events.flatMap(linesOf).filter(({ tone }) => tone === "said" || tone === "asked" || tone === "answered");
    const expected = events.flatMap((event) =>
      event.type === "prompt" ? [event.text] : event.type === "answered" ? [event.answer] : [],
    );
    expect(told.map((line) => line.text)).toEqual(expected);
  });

  it("joins the steps of one start", () => {
    const lines: Line[] = [];
    for (const line of events.slice(0, 11).flatMap(linesOf)) joined(lines, line);
    const steps = lines.filter((line) => line.tone === "step");
    expect(steps).toHaveLength(1);
    expect(steps[0]?.speaker).toBe("green leg");
    expect(steps[0]?.text).toMatch(/^1 above pick · 2 pick · .* · 8 above place$/);
  });

  it("has names as people write them, and every line as the service words it", () => {
    const service = events.flatMap(({ lines }) => lines.map(({ text }) => text.replaceAll("_", " ")));
    expect(events.flatMap(linesOf).map(({ text }) => text)).toEqual(service);
    expect(service.length).toBeGreaterThan(50);
  });
});
