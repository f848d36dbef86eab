// Why a fleet does what it does, in the reader's language.
import { afterEach, beforeEach, describe, expect, it } from "vitest";
import { IN_ENGLISH, REASON_FIELDS } from "../src/fleet/reason_words";
import { REASONS } from "../src/fleet/reasons";
import { reasonInWords, said, takeReasons, takeSentences, translated, translatedReason } from "../src/words/said";
import reasons from "../texts/de/reasons.json";

const NO_PLACE =
  "item 'lunch' has no place in time beside what the robots have to do already: these cannot hold together: " +
  "robot2-7b50080f starts at 104.9435 s; to pick lunch at F1/101 must begin by 3600 s; lunch may be on board for 300 s";

// Other tests read English.
afterEach(() => takeReasons({}, {}));

it("has what the service says in every language", () => {
  expect(Object.keys(reasons)).toEqual(REASONS);
});

describe("in English", () => {
  beforeEach(() => {
    takeSentences({}, {});
    takeReasons(IN_ENGLISH, REASON_FIELDS);
  });

  it("robots, places and times are as people know them", () => {
    expect(reasonInWords(NO_PLACE)).toBe(
      "item 'lunch' has no place in time beside what the robots have to do already: these cannot hold together: " +
        "ROBOT2 starts at 1:45; to pick lunch at F1 101 must begin by 1:00:00; lunch may be on board for 5 min",
    );
  });

  it("no other text is taken for a reason", () => {
    const line = "looks for pink bar at its place until 47.5 s";
    expect(said(line)).toBe(line);
    expect(translated("it was cancelled")).toBeNull();
  });

  it("what is no reason stays as it is", () => {
    expect(reasonInWords("its wheel is stuck; 3.25 s")).toBe("its wheel is stuck; 3.25 s");
  });
});

describe("in German", () => {
  beforeEach(() => {
    takeSentences({}, {});
    takeReasons(reasons, REASON_FIELDS);
  });

  it("every clause of a reason is put into it", () => {
    expect(reasonInWords(NO_PLACE)).toBe(
      "für „lunch“ ist rechtzeitig kein Platz neben dem, was die Roboter schon zu tun haben: das geht nicht zusammen: " +
        "ROBOT2 beginnt um 1:45; bis 1:00:00 muss begonnen sein, „lunch“ in F1 101 abzuholen; „lunch“ darf 5 min an Bord sein",
    );
  });

  it("a deed that failed says what comes of it", () => {
    expect(reasonInWords("ada could not hand over 'mail' at F2/7: nobody came; it is tried again at 90 s")).toBe(
      "ada konnte nicht „mail“ übergeben in F2 7: niemand kam; es wird um 1:30 noch einmal versucht",
    );
    expect(reasonInWords("it was cancelled; it was last in the basket of ada at F2/7, for a person to take it")).toBe(
      "es wurde abgesagt; es war zuletzt im Korb von ada in F2 7, wo jemand es holen kann",
    );
  });

  it("a list is put into it one by one", () => {
    expect(reasonInWords("found closed: lift until 300 s, the way between F1/a and F1/b, 2 more")).toBe(
      "verschlossen gefunden: lift bis 5:00, der Weg zwischen F1 a und F1 b, 2 weitere",
    );
  });

  it("what a person typed stays as it was typed", () => {
    expect(reasonInWords("robot2-7b50080f has failed: Rad klemmt; bitte holen")).toBe("ROBOT2 ist ausgefallen: Rad klemmt; bitte holen");
  });

  it("nothing is half in it that is no reason", () => {
    expect(translatedReason("it was cancelled; its wheel is stuck")).toBeNull();
  });
});
