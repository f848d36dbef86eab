// What a trial of the calls to a device has found, and what it comes to.
import { t } from "../words/words";

/** `unused`: it was not asked for here, or cannot be known. */
export type State = "well" | "bad" | "unused";

export interface Finding {
  what: string;
  state: State;
  /** What was found, and what to do where it is bad. */
  words: string;
}

/** What it comes to, in a sentence or two. */
export function verdict(findings: readonly Finding[]): Finding {
  const is = (what: string) => findings.find((each) => each.what === what)?.state;
  const open = is(t("Sound")) === "well";
  const closed = is(t("A push all the way")) === "well";
  if (is(t("Your turn")) === "bad")
    return { what: t("This device"), state: "bad", words: t("You are not called at all: see the first line.") };
  const beside = [t("Screen stays on"), t("Listens and speaks")].some((what) => is(what) === "bad");
  const words = [
    open && closed && t("This device calls you, whether this page is open or not."),
    open && !closed && t("This device calls you only as long as this page is open."),
    !open && closed && t("This device shows you that a robot asks, but this page makes no sound."),
    !open && !closed && t("This device does not call you."),
    beside && t("It cannot do all that is wanted of one beside a robot."),
  ].filter(Boolean);
  return { what: t("This device"), state: (open || closed) && !beside ? "well" : "bad", words: words.join(" ") };
}
