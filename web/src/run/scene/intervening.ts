// What a person is doing in the scene: a menu that is open, an object to be put somewhere, and what came of it.
import { useEffect, useState } from "preact/hooks";
import { onEvent } from "../../state/service";
import * as rest from "../../wire/rest";
import type { Intervention } from "../../wire/types";
import { type Offer, sentenceOn, type Target } from "./interventions";
import { armTarget } from "./object_list";
import type { PoseSource } from "./pose_source";
import type { Pointed } from "./scene_view";
import { said, whyNotDone } from "../../words/said";
import { t } from "../../words/words";

interface OpenMenu {
  readonly target: Target;
  readonly x: number;
  readonly y: number;
}

/** `offered`: whether anything can be done now. */
export function useIntervening(run: string, offered: boolean, source: PoseSource) {
  const [menu, setMenu] = useState<OpenMenu | null>(null);
  const [chosen, setChosen] = useState<string | null>(null);
  const [note, setNote] = useState("");
  const putting = offered ? chosen : null;

  // The service passes an intervention on at once; whether the world could do it comes as an event.
  useEffect(
    () =>
      onEvent((event) => {
        if (event.type !== "intervention" || event.run !== run) return;
        setNote(
          event.ok ? sentenceOn(event.intervention) : t("That could not be done: {detail}.", { detail: said(event.detail) }),
        );
      }),
    [run],
  );
  const act = (intervention: Intervention) => {
    setChosen(null);
    rest.intervene(run, intervention).catch((error: Error) => setNote(whyNotDone(error)));
  };
  const take = (offer: Offer, target: Target) => {
    setMenu(null);
    if (offer.act !== "where") act(offer.act);
    else if (target.kind === "object") setChosen(target.name);
  };
  const choose = (what: Pointed, at: { x: number; y: number }) => {
    if (putting !== null) {
      if (what.kind === "table") act({ act: "move", object: putting, to: spotOnTable(what) });
      return;
    }
    const target = what.kind === "table" || !offered ? null : targetOf(what, source);
    setMenu(target === null ? null : { target, ...at });
  };
  return {
    menu: offered ? menu : null,
    /** The object whose new place is being chosen. */
    putting,
    note,
    say: setNote,
    act,
    take,
    choose,
    closeMenu: () => setMenu(null),
    giveUp: () => setChosen(null),
  };
}

function targetOf(what: Exclude<Pointed, { kind: "table" }>, source: PoseSource): Target | null {
  const whereabouts = source.whereabouts.peek();
  if (what.kind === "arm") return armTarget(whereabouts);
  const found = whereabouts.find((each) => each.name === what.name);
  return found === undefined ? null : { ...found, kind: "object" };
}

// To the millimetre: whoever clicks means no more than that.
function spotOnTable({ x, y }: { x: number; y: number }) {
  return { x: Math.round(x * 1000) / 1000, y: Math.round(y * 1000) / 1000 };
}
