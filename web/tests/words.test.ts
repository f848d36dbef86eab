import { afterEach, beforeEach, describe, expect, it } from "vitest";
import { problems } from "../scripts/check_words.mjs";
import sentences from "../texts/de/sentences.json";
import clauses from "../texts/de/clauses.json";
import refusals from "../texts/de/refusals.json";
import { languageOf } from "../src/words/language";
import { takeClauses, takeSentences, learn, said, translated, whyNotDone } from "../src/words/said";
import { Refusal } from "../src/wire/rest";
import { parts, t, tn } from "../src/words/words";

describe("the language of a page", () => {
  it("is the one that was chosen on the device", () => {
    expect(languageOf("en", ["de-AT"], ["en", "de"])).toBe("en");
  });

  it("is else the first of the browser's that there are words in", () => {
    expect(languageOf("", ["fr-FR", "de-AT", "en"], ["en", "de"])).toBe("de");
    expect(languageOf("", ["fr"], ["en", "de"])).toBe("en");
  });
});

describe("a text", () => {
  it("is the English one where no other is there", () => {
    expect(t("Attempt {attempt} of {attempts}", { attempt: 1, attempts: 3 })).toBe("Attempt 1 of 3");
    expect(t("Place|to put it there")).toBe("Place");
  });

  it("depends on how many", () => {
    expect(tn("{count} fault", "{count} faults", { count: 1 })).toBe("1 fault");
    expect(tn("{count} fault", "{count} faults", { count: 1200 })).toBe("1,200 faults");
  });

  it("may have what is no text in its fields", () => {
    const link = { name: "anna" };
    expect(parts("{by} is on it", { by: link as never })).toEqual(["", link, " is on it"]);
  });
});

describe("what the service says", () => {
  beforeEach(() => takeSentences(sentences, clauses));
  afterEach(() => takeSentences({}, {}));

  const missed = {
    text: "I missed the red leg. The red leg is nowhere in the head picture. Will you put it back on the table?",
    sentences: [
      { key: "I missed the {object}.", args: { object: "red leg" } },
      { key: "{clause}.", args: { clause: [{ key: "the red leg is nowhere in the head picture", args: {} }] } },
      { key: "Will you put it back on the table?", args: {} },
    ],
  };

  it("is said of what people did in vain, and of mistakes in files, each part of it", () => {
    takeClauses(refusals);
    expect(said("takes the red leg away: in vain, the run is paused")).toBe(
      "nimmt „red leg“ weg: vergeblich, der Lauf ist angehalten",
    );
    expect(said("'objects.cup.pose.x' must be a number (in metres), but it is a list")).toBe(
      "„objects.cup.pose.x“ muss eine Zahl (in Metern) sein, ist aber eine Liste",
    );
    expect(said("this is a scene, and not a task tree: a task tree names it as its 'scene'")).toBe(
      "das ist eine Szene, nicht ein Aufgabenbaum: ein Aufgabenbaum nennt sie als „scene“",
    );
  });

  it("is said of what is refused while somebody answers", () => {
    expect(said("anna is on this dialogue for 12 s more; 'take_over' takes it from them")).toBe(
      "anna kümmert sich noch 12 s darum; Sie können es übernehmen",
    );
    expect(said("this dialogue is closed (aborted)")).toContain("der Roboter hat diese Aufgabe beendet");
    expect(whyNotDone(new Refusal(409, "this question was already answered by anna"))).toBe("diese Frage hat anna schon beantwortet");
    expect(whyNotDone(new Error("nobody has put this into German"))).toBe("nobody has put this into German");
  });

  it("is said of what it is made of", () => {
    learn([missed]);
    expect(said(missed.text)).toBe(
      "Ich habe „red leg“ verfehlt. „red leg“ ist nirgends im Bild der Kopfkamera. Legen Sie es auf den Tisch zurück?",
    );
  });

  it("is said of a thing that nobody has named, too", () => {
    const part = [{ key: "thing to be brought", args: {} }];
    const put_in = [{ key: "put {it} into my basket", args: { it: [{ key: "the {part}", args: { part } }] } }];
    const text = "Please put the thing to be brought into my basket.";
    learn([{ text, sentences: [{ key: "Please {put_in}.", args: { put_in } }] }]);
    expect(said(text)).toBe("Bitte „was gebracht werden soll“ in meinen Korb legen.");
    expect(said("I have come to 101 to collect the thing to be brought")).toContain("um „was gebracht werden soll“ abzuholen");
    expect(said("I have come to 101 to collect the thing to be brought from F1 101")).toContain("was von F1 101 gebracht werden soll");
  });

  it("stays English where one of its sentences is of a script that nobody has translated", () => {
    learn([{ text: "It squeaks. Will you oil it?", sentences: [{ key: "It squeaks.", args: {} }] }]);
    expect(translated("It squeaks. Will you oil it?")).toBeNull();
  });

  it("leaves a reason in English that it does not know, and says the rest", () => {
    const text = "I missed the cup. It squeaks.";
    const clause = [{ key: "it squeaks", args: {} }];
    learn([
      { text, sentences: [{ key: "I missed the {object}.", args: { object: "cup" } }, { key: "{clause}.", args: { clause } }] },
    ]);
    expect(said(text)).toBe("Ich habe „cup“ verfehlt. It squeaks.");
  });

  it("is known by its pattern where nobody says what it is made of, as in old records", () => {
    expect(said("the red leg is 0.90 m away; the arm grasps 0.40 to 0.80 m")).toBe(
      "„red leg“ ist 0.90 m entfernt; der Arm greift von 0.40 bis 0.80 m",
    );
    expect(said("the run has failed: no help was seen")).toBe("der Lauf ist gescheitert: es wurde keine Hilfe gesehen");
    expect(translated("nobody knows this")).toBeNull();
  });
});

it("is in every language as the code says it, and nothing is said in English alone", () => {
  expect(problems()).toEqual([]);
});
