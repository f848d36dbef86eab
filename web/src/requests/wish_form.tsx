// The form in which somebody asks robots of a building for something.
import { useId, useState } from "preact/hooks";
import type { FleetView, RequestKind } from "../wire/types";
import { Confirming } from "./confirming";
import { InWords } from "./in_words";
import { exampleFor } from "./example";
import { placeInWords, placeMeant } from "./places";
import { Refused } from "./refused";
import { Unanswered } from "./unanswered";
import type { RequestDocument, UseAsking } from "./use_asking";
import { type Kind, missing, newName, NO_WISH, requestOf, type Wish, withinWhat } from "./wish";
import type { SiteClock } from "./when";
import { t } from "../words/words";

const KINDS: readonly (readonly [Kind, string, string])[] = [
  ["transport", t("Bring something"), t("A robot fetches it and hands it over.")],
  ["deliver_message", t("Tell something"), t("A robot comes and tells it.")],
  ["go_to_room", t("Have a robot come"), t("It comes, and goes on to whoever else wants it.")],
  ["escort", t("Show somebody the way"), t("A robot meets them and goes ahead.")],
];

interface WishFormProps extends UseAsking {
  fleet: FleetView;
  kinds: readonly RequestKind[];
  clock: SiteClock;
}

export function WishForm({ fleet, kinds, clock, asking, ask, forget }: WishFormProps) {
  const [wish, setWish] = useState<Wish>(NO_WISH);
  const [mistake, setMistake] = useState("");
  const [words, setWords] = useState("");
  const [inWords, setInWords] = useState<{ request: RequestDocument; readBack: string } | null>(null);
  const list = useId();
  const fill = (change: Partial<Wish>) => {
    setWish({ ...wish, ...change });
    setMistake("");
    if (asking.phase === "refused" || asking.phase === "unknown") forget();
  };
  const send = async () => {
    if (asking.phase === "unknown") return ask(asking.request);
    const wanted = withPlaces(wish, fleet.places);
    const wrong = missing(wanted.wish, fleet.now_s) || wanted.mistake;
    setMistake(wrong);
    if (wrong === "") await ask(requestOf(wanted.wish, fleet.now_s, newName()));
  };
  const busy = asking.phase === "sending";
  const booked = asking.phase === "booked" ? asking.request.name : null;
  const [seen, setSeen] = useState<string | null>(null);
  if (booked !== seen) {
    // What is booked is not asked for once more by mistake.
    setSeen(booked);
    if (booked !== null) {
      setWish({ ...NO_WISH, kind: wish.kind });
      setWords("");
      setInWords(null);
    }
  }
  return (
    <section class="panel wish" aria-labelledby="wish-heading">
      <h2 id="wish-heading">{t("Ask for something")}</h2>
      {inWords === null ? (
        <InWords
          site={fleet.site}
          robot={null}
          example={exampleFor(fleet.places)}
          words={words}
          typed={setWords}
          understood={(request, readBack) => {
            forget();
            setInWords({ request, readBack });
          }}
        />
      ) : (
        <Confirming
          readBack={inWords.readBack}
          busy={busy}
          yes={() => void ask(inWords.request)}
          no={() => {
            setInWords(null);
            forget();
          }}
        />
      )}
      <form
        class="wish"
        aria-label={t("Fill in what you want")}
        onSubmit={(event) => {
          event.preventDefault();
          void send();
        }}
      >
        <fieldset class="wish-kinds">
          <legend class="label">{t("Or fill in what you want")}</legend>
          <div class="choices">
            {KINDS.filter(([kind]) => kind !== "escort" || kinds.includes(kind)).map(([kind, name, about]) => (
              <label key={kind} class="choice">
                <input type="radio" name="kind" checked={wish.kind === kind} onChange={() => fill({ kind })} />
                <span>
                  <strong>{name}</strong>
                  <span class="small quiet">{about}</span>
                </span>
              </label>
            ))}
          </div>
        </fieldset>
        <div class="wish-fields">
          {wish.kind === "transport" && (
            <Words label={t("What is to be brought")} value={wish.what} onInput={(what) => fill({ what })} />
          )}
          {wish.kind === "escort" && (
            <Words label={t("Who is to be shown the way")} value={wish.person} onInput={(person) => fill({ person })} />
          )}
          {wish.kind === "deliver_message" && (
            <Words label={t("What is to be told")} value={wish.message} onInput={(message) => fill({ message })} />
          )}
          {wish.kind === "transport" || wish.kind === "escort" ? (
            <>
              <PlaceField label={t("From")} list={list} value={wish.origin} onInput={(origin) => fill({ origin })} />
              <PlaceField label={t("To|where")} list={list} value={wish.destination} onInput={(destination) => fill({ destination })} />
            </>
          ) : (
            <PlaceField label={t("Where")} list={list} value={wish.place} onInput={(place) => fill({ place })} />
          )}
          <div class="field">
            <label for="wish-within">{withinWhat(clock)}</label>
            <input
              id="wish-within"
              type="text"
              inputMode="numeric"
              autocomplete="off"
              value={wish.within}
              onInput={(event) => fill({ within: event.currentTarget.value })}
            />
          </div>
        </div>
        <datalist id={list}>
          {fleet.places.map((place) => (
            <option key={place} value={placeInWords(place)} />
          ))}
        </datalist>
        <p class="mistake" role="alert">
          {mistake}
        </p>
        <div class="wish-buttons">
          <button class="button primary" type="submit" disabled={busy}>
            {t("Ask for it")}
          </button>
        </div>
      </form>
      <Unanswered asking={asking} ask={(request) => void ask(request)} />
      {asking.phase === "refused" && <Refused refused={asking} clock={clock} ask={(request) => void ask(request)} />}
    </section>
  );
}

/** The wish with places for what was written, and what is wrong with that. */
function withPlaces(wish: Wish, places: readonly string[]): { wish: Wish; mistake: string } {
  const found = { ...wish };
  let mistake = "";
  for (const field of ["origin", "destination", "place"] as const) {
    if (wish[field].trim() === "") continue;
    const place = placeMeant(wish[field], places);
    if (typeof place === "string") found[field] = place;
    else mistake ||= place.mistake;
  }
  return { wish: found, mistake };
}

const LONGEST = 300;

function Words({ label, value, onInput }: { label: string; value: string; onInput: (value: string) => void }) {
  const id = useId();
  return (
    <div class="field wish-words">
      <label for={id}>{label}</label>
      <input
        id={id}
        type="text"
        autocomplete="off"
        maxLength={LONGEST}
        value={value}
        onInput={(event) => onInput(event.currentTarget.value)}
      />
    </div>
  );
}

interface PlaceFieldProps {
  label: string;
  /** The id of the list of places. */
  list: string;
  value: string;
  onInput: (written: string) => void;
}

function PlaceField({ label, list, value, onInput }: PlaceFieldProps) {
  const id = useId();
  return (
    <div class="field">
      <label for={id}>{label}</label>
      <input
        id={id}
        type="text"
        autocomplete="off"
        placeholder={t("Room")}
        list={list}
        value={value}
        onInput={(event) => onInput(event.currentTarget.value)}
      />
    </div>
  );
}
