// The form in which somebody asks robots of a building for something.
import { useId, useState } from "preact/hooks";
import * as rest from "../wire/rest";
import { Refusal } from "../wire/rest";
import type { FleetView } from "../wire/types";
import { within } from "./request_words";
import { type Kind, missing, NO_WISH, requestOf, type Wish } from "./wish";

const KINDS: readonly (readonly [Kind, string, string])[] = [
  ["transport", "Bring something", "A robot fetches it and hands it over."],
  ["deliver_message", "Tell something", "A robot comes and tells it."],
  ["go_to_room", "Have a robot come", "It comes, and goes on to whoever else wants it."],
];
const UNLIKE_CHARS = 4;

interface WishFormProps {
  fleet: FleetView;
  /** Something was asked for. */
  asked: () => void;
}

export function WishForm({ fleet, asked }: WishFormProps) {
  const [wish, setWish] = useState<Wish>(NO_WISH);
  const [failure, setFailure] = useState("");
  const [instead, setInstead] = useState<number | null>(null);
  const [sending, setSending] = useState(false);
  const fill = (change: Partial<Wish>) => {
    setWish({ ...wish, ...change });
    setFailure("");
    setInstead(null);
  };
  const send = async (wanted: Wish) => {
    const mistake = missing(wanted);
    setFailure(mistake);
    setInstead(null);
    if (mistake !== "") return;
    setSending(true);
    try {
      await rest.makeRequest(fleet.site, requestOf(wanted, fleet.now_s, crypto.randomUUID().slice(0, UNLIKE_CHARS)));
      setWish({ ...NO_WISH, kind: wanted.kind });
      asked();
    } catch (error) {
      setFailure(error instanceof Error ? error.message : String(error));
      const by = error instanceof Refusal ? error.nextPossible?.[1] : undefined;
      setInstead(by === undefined ? null : Math.ceil((by - fleet.now_s) / 60));
    } finally {
      setSending(false);
    }
  };
  return (
    <form
      class="panel wish"
      aria-labelledby="wish-heading"
      onSubmit={(event) => {
        event.preventDefault();
        void send(wish);
      }}
    >
      <h2 id="wish-heading">Ask for something</h2>
      <fieldset class="wish-kinds">
        <legend class="label">What</legend>
        <div class="choices">
          {KINDS.map(([kind, name, about]) => (
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
          <>
            <Words label="What is to be brought" value={wish.what} onInput={(what) => fill({ what })} />
            <PlaceChoice label="From" places={fleet.places} value={wish.origin} onChange={(origin) => fill({ origin })} />
            <PlaceChoice label="To" places={fleet.places} value={wish.destination} onChange={(destination) => fill({ destination })} />
          </>
        )}
        {wish.kind === "deliver_message" && (
          <Words label="What is to be told" value={wish.message} onInput={(message) => fill({ message })} />
        )}
        {wish.kind !== "transport" && (
          <PlaceChoice label="Where" places={fleet.places} value={wish.place} onChange={(place) => fill({ place })} />
        )}
        <div class="field">
          <label for="wish-within">Within (minutes)</label>
          <input
            id="wish-within"
            type="text"
            inputMode="numeric"
            value={wish.within}
            onInput={(event) => fill({ within: event.currentTarget.value })}
          />
        </div>
      </div>
      <p class="mistake" role="alert">
        {failure}
      </p>
      <div class="wish-buttons">
        <button class="button primary" type="submit" disabled={sending}>
          Ask for it
        </button>
        {instead !== null && (
          <button class="button" type="button" onClick={() => void send({ ...wish, within: String(instead) })}>
            Ask for it {within(60 * instead)} instead
          </button>
        )}
      </div>
    </form>
  );
}

const LONGEST = 300;

function Words({ label, value, onInput }: { label: string; value: string; onInput: (value: string) => void }) {
  const id = useId();
  return (
    <div class="field wish-words">
      <label for={id}>{label}</label>
      <input id={id} type="text" maxLength={LONGEST} value={value} onInput={(event) => onInput(event.currentTarget.value)} />
    </div>
  );
}

interface PlaceChoiceProps {
  label: string;
  places: readonly string[];
  value: string;
  onChange: (place: string) => void;
}

function PlaceChoice({ label, places, value, onChange }: PlaceChoiceProps) {
  const id = useId();
  return (
    <div class="field">
      <label for={id}>{label}</label>
      <select id={id} value={value} onChange={(event) => onChange(event.currentTarget.value)}>
        <option value="">Choose a place</option>
        {places.map((place) => (
          <option key={place} value={place}>
            {place.replace("/", " ")}
          </option>
        ))}
      </select>
    </div>
  );
}
