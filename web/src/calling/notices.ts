// How a call looks as a notification: the same whether it was pushed or the page itself shows it.
import { robotName } from "../question/fault_words";
import type { CallMessage, RobotLostMessage, WithdrawnMessage } from "../wire/types";
import { t } from "../words/words";
import { learn, said } from "../words/said";

/** What notifications can have beyond what TypeScript knows. */
export interface NoticeOptions extends NotificationOptions {
  renotify?: boolean;
  vibrate?: readonly number[];
}

export interface Notice {
  title: string;
  options: NoticeOptions;
}

/** What is over is told under one tag: it never piles up. */
export const OVER = "over";
const TRIAL = "trial";
const LOOKS = { icon: "/icons/192.png", badge: "/icons/badge.png" };

/** `quiet`: the page is before somebody's eyes, and makes itself heard. */
export function callNotice(call: Omit<CallMessage, "type">, quiet: boolean): Notice {
  const robot = robotName(call.robot);
  learn([{ text: call.text, sentences: call.sentences }]);
  return {
    title: call.urgent ? t("{robot} needs help now", { robot }) : t("{robot} asks for help", { robot }),
    options: {
      ...LOOKS,
      body: said(call.text),
      tag: call.dialogue,
      renotify: true,
      requireInteraction: true,
      silent: quiet,
      // Both at once are refused.
      ...(quiet ? {} : { vibrate: call.urgent ? [500, 150, 500, 150, 800] : [200, 120, 200] }),
      data: { dialogue: call.dialogue },
    },
  };
}

/** A robot is gone: nobody asks, and somebody has to see after it. */
export function lostNotice({ dialogue, robot }: Omit<RobotLostMessage, "type" | "run">, quiet: boolean): Notice {
  return {
    title: t("{robot} is gone", { robot: robotName(robot) }),
    options: {
      ...LOOKS,
      body: t("Its run waits for it. See whether it has power and a connection."),
      tag: dialogue,
      renotify: true,
      requireInteraction: true,
      silent: quiet,
      ...(quiet ? {} : { vibrate: [200, 120, 200] }),
    },
  };
}

export function overNotice({ robot, text }: WithdrawnMessage): Notice {
  const title = robot === "" ? t("You are not needed now") : t("{robot}: you are not needed now", { robot: robotName(robot) });
  return { title, options: { ...LOOKS, body: said(text), tag: OVER, silent: true } };
}

export function trialNotice(): Notice {
  return {
    title: t("Mend can call this device"),
    options: { ...LOOKS, body: t("A push has come all the way. This is how a robot's question looks."), tag: TRIAL },
  };
}
