// What is sent while answers are lost: once more under its key, until it is known or nobody can say.
import { describe, expect, it } from "vitest";
import { Refusal, Unreachable } from "../src/wire/rest";
import { untilAnswered } from "../src/wire/until_answered";

const STILL_UNDER_WAY = new Refusal(409, "still under way", [], null, null, null, true);

/** What comes of it, how often it was sent, and how often an answer was lost. */
async function sent(...answers: readonly unknown[]) {
  let times = 0;
  let lost = 0;
  const send = () => {
    const answer = answers[Math.min(times++, answers.length - 1)];
    return answer instanceof Error ? Promise.reject(answer) : Promise.resolve(answer);
  };
  const result = await untilAnswered(send, () => lost++, () => Promise.resolve()).catch((error: unknown) => error);
  return { result, times, lost };
}

describe("what is sent under a key", () => {
  it("is sent once where it is answered", async () => {
    expect(await sent("booked")).toEqual({ result: "booked", times: 1, lost: 0 });
  });

  it.each([
    ["the service was not there", new Unreachable()],
    ["half an answer came", new SyntaxError("Unexpected end of JSON input")],
    ["it took too long", new DOMException("signal timed out", "TimeoutError")],
    ["a proxy did not find it", new Refusal(502, "Bad Gateway")],
    ["it is still being done", STILL_UNDER_WAY],
  ])("is sent once more where %s", async (_, error) => {
    expect(await sent(error, error, "booked")).toEqual({ result: "booked", times: 3, lost: 2 });
  });

  it("is refused where the service says so, also after a lost answer", async () => {
    const refused = new Refusal(409, "cannot be met");
    expect(await sent(new Unreachable(), refused)).toEqual({ result: refused, times: 2, lost: 1 });
  });

  it("is not known to be done where no answer comes at all", async () => {
    expect(await sent(new Unreachable())).toEqual({ result: null, times: 5, lost: 5 });
  });
});
