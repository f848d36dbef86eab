// A robot's touch screen: large buttons for what may be asked, read back, asked for and followed.
import { useState } from "preact/hooks";
import { Connection } from "../app/header";
import { robotName } from "../question/fault_words";
import { Confirming } from "../requests/confirming";
import { exampleFor } from "../requests/example";
import { Followed } from "../requests/followed";
import { InWords } from "../requests/in_words";
import { Refused, refusedInShort } from "../requests/refused";
import { notKnown, Unanswered } from "../requests/unanswered";
import { fleets } from "../requests/fleets";
import { placeInWords } from "../requests/places";
import { type Asking, followed, type RequestDocument, useAsking } from "../requests/use_asking";
import { useRequests } from "../requests/use_requests";
import { isOver, wanted } from "../requests/request_words";
import { type Kind, newName, requestOf } from "../requests/wish";
import { may, whyNot } from "../state/access";
import { soundOn } from "../state/preferences";
import type { AskedRobotView, SiteView } from "../wire/types";
import { useHasVoice, useSaidAloud } from "./said_aloud";
import { type Service, serviceOf } from "./service";
import { StepForm } from "./step_form";
import { type Asked, nextStep, readBackOf, textOf, wishOf } from "./steps";
import { useIdle } from "./use_idle";
import { useRobot } from "./use_robot";
import "../requests/requests.css";
import { t } from "../words/words";
import "./touch.css";

const DEEDS: readonly (readonly [Kind, string])[] = [
  ["transport", t("Bring something somewhere")],
  ["deliver_message", t("Tell somebody something")],
  ["escort", t("Show me the way")],
  ["go_to_room", t("Come to a room")],
];
const IDLE_MS = 90_000;

export function TouchView({ robot: name }: { robot: string }) {
  const { site, robot, failure } = useRobot(name);
  const voices = useHasVoice();
  return (
    <section class="page touch">
      <div class="touch-head">
        <h1>{robotName(name)}</h1>
        {robot?.connected && robot.here !== null && failure === "" && <p class="quiet">{t("I am at {here}.", { here: placeInWords(robot.here) })}</p>}
        <Connection but={robot?.connected === false ? t("I am not connected.") : ""} />
        {voices && (
          <button class="button" type="button" aria-pressed={soundOn.value} onClick={() => (soundOn.value = !soundOn.value)}>
            {t("Read aloud")}
          </button>
        )}
      </div>
      <p class="mistake" role="alert">
        {failure}
      </p>
      {fleets.value !== null && site === null && <p>{t("No robot called {name} takes requests here.", { name })}</p>}
      {!may("helper") && <p class="quiet">{whyNot(t("Asking for something"), "helper")}</p>}
      {may("helper") && site !== null && robot !== null && <AtRobot site={site} robot={robot} />}
    </section>
  );
}

/** In words, or for a kind of request: kept until it is booked, or whoever has typed it has gone. */
const NOTHING_TYPED: Readonly<Record<Kind | "words", string>> = {
  words: "",
  transport: "",
  deliver_message: "",
  escort: "",
  go_to_room: "",
};

interface ToConfirm {
  request: RequestDocument;
  readBack: string;
}

function AtRobot({ site, robot }: { site: SiteView; robot: AskedRobotView }) {
  const { asking, ask, forget } = useAsking(site.id);
  const { requests, fleet, again } = useRequests(site.id);
  const [asked, setAsked] = useState<Asked | null>(null);
  const [confirmed, setConfirmed] = useState<ToConfirm | null>(null);
  const [typed, setTyped] = useState(NOTHING_TYPED);
  const change = (next: Asked | null) => {
    forget();
    setAsked(next);
    setConfirmed(null);
  };
  const back = () => {
    change(null);
    setTyped(NOTHING_TYPED);
  };
  const booked = followed(asking, requests);
  const goesOn = booked !== null && !isOver(booked);
  const isSending = asking.phase === "sending";
  const isTouched = asked !== null || confirmed !== null || typed !== NOTHING_TYPED;
  useIdle(isTouched && !goesOn && !isSending, IDLE_MS, back);
  useSaidAloud(heard(asking, confirmed?.readBack ?? ""));
  if (fleet === null) return <p class="quiet">{t("Loading …")}</p>;
  const clock = { now: fleet.now_s, speed: site.speed };
  const answer = (next: Asked) => {
    setAsked(next);
    const text = textOf(next);
    if (text !== null) setTyped({ ...typed, [next.kind]: text });
    if (nextStep(next) !== null) return;
    const wish = wishOf(next, robot.here);
    setConfirmed({ request: requestOf(wish, fleet.now_s, newName()), readBack: readBackOf(wish) });
  };
  const isStart = asked === null && confirmed === null;
  const service = serviceOf(robot.robot, fleet);
  return (
    <>
      {isStart && service === "alone" && <h2>{t("I am out of service, and no other robot works now. Please try again later.")}</h2>}
      {isStart && service !== "alone" && <Start robot={robot} service={service} choose={(kind) => setAsked({ kind, answers: [] })} />}
      {isStart && service !== "alone" && (
        <InWords
          site={site.id}
          robot={robot.robot}
          example={exampleFor(fleet.places, robot.connected ? robot.here : null)}
          words={typed.words}
          typed={(words) => setTyped({ ...typed, words })}
          understood={(request, readBack) => setConfirmed({ request, readBack })}
        />
      )}
      {asked !== null && confirmed === null && (
        <StepForm asked={asked} places={fleet.places} here={robot.here} typed={typed[asked.kind]} answered={answer} />
      )}
      {confirmed !== null && (asking.phase === "nothing" || isSending) && (
        <Confirming
          readBack={confirmed.readBack}
          busy={isSending}
          yes={() => void ask(confirmed.request).then(again)}
          no={() => change(null)}
        />
      )}
      <Unanswered asking={asking} ask={(request) => void ask(request).then(again)} />
      {asking.phase === "refused" && <Refused refused={asking} clock={clock} ask={(request) => void ask(request).then(again)} />}
      {asking.phase === "refused" && (
        <button class="button touch-button" type="button" onClick={() => change(asked === null ? null : { ...asked, answers: [] })}>
          {t("Ask for it in other words")}
        </button>
      )}
      {booked !== null && <Followed request={booked} clock={clock} changed={again} at={robot.robot} />}
      {!isStart && !isSending && !(confirmed !== null && asking.phase === "nothing") && (
        <button class="button touch-button" type="button" onClick={back}>
          {asking.phase === "booked" ? t("Ask for something else") : t("Start over")}
        </button>
      )}
    </>
  );
}

interface StartProps {
  robot: AskedRobotView;
  service: Service;
  choose: (kind: Kind) => void;
}

function Start({ robot, service, choose }: StartProps) {
  const offered = DEEDS.filter(([kind]) => robot.kinds.includes(kind) && (kind !== "escort" || robot.here !== null));
  return (
    <>
      <h2>
        {service === "in"
          ? t("What may I do for you?")
          : t("I am out of service, but you may ask here: another robot will come. What may it do for you?")}
      </h2>
      <div class="touch-deeds">
        {offered.map(([kind, name]) => (
          <button key={kind} class="button touch-button" type="button" onClick={() => choose(kind)}>
            {name}
          </button>
        ))}
      </div>
    </>
  );
}

function heard(asking: Asking, readBack: string): string {
  if (asking.phase === "booked") return t("All right. {request}.", { request: wanted(asking.request) });
  if (asking.phase === "unknown") return notKnown();
  return asking.phase === "refused" ? refusedInShort(asking.by) : readBack;
}
