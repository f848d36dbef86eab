// The objects as a list: where each is, and what can be done with it, without the 3-D picture.
import { useState } from "preact/hooks";
import { offersFor, type Offer, plain, type Target } from "./interventions";
import { OfferMenu } from "./offer_menu";
import type { Whereabouts } from "./pose_source";
import { t } from "../../words/words";

interface Props {
  whereabouts: readonly Whereabouts[];
  places: readonly string[];
  doers: ReadonlyMap<string, string>;
  /** Whether anything can be done now. */
  offered: boolean;
  onChoose(offer: Offer, target: Target): void;
  onPoint(name: string | null): void;
}

export function ObjectList({ whereabouts, places, doers, offered, onChoose, onPoint }: Props) {
  const [open, setOpen] = useState<string | null>(null);
  const row = (key: string, title: string, where: string, target: Target) => (
    <li key={key} class="scene-row" onPointerEnter={() => onPoint(key)} onPointerLeave={() => onPoint(null)}>
      <span class="scene-row-name">{title}</span>
      <span class="scene-row-where small quiet">{where}</span>
      {offered && (
        <button
          type="button"
          class="button"
          aria-haspopup="menu"
          aria-expanded={open === key}
          aria-label={t("Intervene: {title}", { title })}
          onFocus={() => onPoint(key)}
          onBlur={() => onPoint(null)}
          onClick={() => setOpen(open === key ? null : key)}
        >
          {t("Intervene")}
        </button>
      )}
      {offered && open === key && (
        <OfferMenu
          label={title}
          offers={offersFor(target, places)}
          onClose={() => setOpen(null)}
          onChoose={(offer) => {
            setOpen(null);
            onChoose(offer, target);
          }}
        />
      )}
    </li>
  );
  return (
    <ul class="scene-list" aria-label={t("Objects, the arm and the camera")}>
      {whereabouts
        .filter((each) => each.kind === "object")
        .map((each) => row(each.name, plain(each.name), wordsFor(each, doers.get(each.name)), { ...each, kind: "object" }))}
      {row(ARM, t("the arm’s way"), armIsBlocked(whereabouts) ? t("blocked") : t("free"), armTarget(whereabouts))}
      {row(HEAD, t("the head camera"), "", { kind: "head" })}
    </ul>
  );
}

// No name of a scene begins so.
const ARM = "*arm";
const HEAD = "*head";

function wordsFor({ held, gone, hidden }: Whereabouts, doer?: string): string {
  if (doer !== undefined) return t("{doer} has taken it", { doer });
  if (gone) return t("taken away");
  if (held) return t("held by the robot");
  if (hidden) return t("not to be seen now");
  return t("in sight");
}

export function armTarget(whereabouts: readonly Whereabouts[]): Target {
  return { kind: "arm", blocked: armIsBlocked(whereabouts) };
}

function armIsBlocked(whereabouts: readonly Whereabouts[]): boolean {
  return whereabouts.some((each) => each.kind === "obstacle" && !each.gone && !each.hidden);
}
