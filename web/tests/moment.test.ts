import { describe, expect, it } from "vitest";
import { createMoment } from "../src/run/moment";

function reached(time: number) {
  const moment = createMoment();
  moment.reach(time);
  return moment;
}

describe("moment", () => {
  it("follows the newest until another one is chosen", () => {
    const moment = reached(5);
    moment.reach(8);
    expect(moment.time.value).toBe(8);
    expect(moment.live.value).toBe(true);
    moment.goTo(3);
    moment.reach(9);
    expect(moment.time.value).toBe(3);
    expect(moment.live.value).toBe(false);
  });

  it("is live again at the right end", () => {
    const moment = reached(5);
    moment.goTo(3);
    moment.goTo(5);
    moment.reach(6);
    expect(moment.live.value).toBe(true);
    expect(moment.time.value).toBe(6);
  });

  it("stays at an event of the end that is named", () => {
    const moment = reached(5);
    moment.goTo(5, 17);
    expect(moment.newest.value).toBe(false);
    expect(moment.seq.value).toBe(17);
  });

  it("is not live in a run that has ended", () => {
    const moment = reached(5);
    moment.finish();
    expect(moment.newest.value).toBe(true);
    expect(moment.live.value).toBe(false);
  });

  it("plays from the beginning once the end is shown, at its speed, and stops at the end", () => {
    const moment = reached(10);
    moment.finish();
    moment.play();
    moment.playAt(4);
    moment.advance(1);
    expect(moment.time.value).toBe(4);
    moment.advance(2);
    expect(moment.newest.value).toBe(true);
    expect(moment.playing.value).toBe(false);
  });

  it("keeps its time while it is paused", () => {
    const moment = reached(10);
    moment.goTo(2);
    moment.advance(1);
    moment.play();
    moment.pause();
    moment.advance(1);
    expect(moment.time.value).toBe(2);
  });

  it("stays within the run", () => {
    const moment = reached(10);
    moment.goTo(-4);
    expect(moment.time.value).toBe(0);
  });
});
