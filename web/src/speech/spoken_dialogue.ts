// The spoken side of the question that is shown: says it, listens, and answers as a click would.
import { effect, untracked } from "@preact/signals";
import { answer, choose, held } from "../question/answering";
import { actOn } from "../question/claiming";
import { say as sayOfHelp } from "../question/promise";
import { shown } from "../question/queue";
import { onRepeat } from "../question/repeating";
import { isTurnOf } from "../question/turn";
import { tellEnding } from "../state/endings";
import { helperName } from "../state/preferences";
import { awaitingHelp, dialogueOf, type Question, together } from "../state/questions";
import * as rest from "../wire/rest";
import type { SpeechView, ToSpeaker } from "../wire/types";
import { type Microphone, openMicrophone } from "./microphone";
import { connectSpeech, type SpeechSocket } from "./speech_socket";
import { lastHeard, listensTo, speechLacks, speechPhase } from "./speech_state";
import { hush, say } from "./voice";
import { t } from "../words/words";
import { whyNotDone } from "../words/said";
import { browserVoices } from "./browser_voice";
import { language, nameOf } from "../words/language";

/** Switch it on; resolves with how to switch it off. */
export async function beginToSpeak(): Promise<() => void> {
  const [abilities, mistake, microphone] = await abilitiesAndMicrophone();
  const conversation = new SpokenDialogue(abilities.recognition && microphone !== null);
  if (microphone !== null) microphone.onFrame = (pcm) => conversation.hear(pcm);
  listensTo.value = abilities.listensTo;
  speechLacks.value = [...abilities.lacks, ...(mistake === null ? [] : [mistake])].join(" ");
  return () => {
    conversation.end();
    microphone?.close();
    speechPhase.value = "off";
    speechLacks.value = "";
    lastHeard.value = null;
  };
}

interface Abilities {
  listensTo: typeof listensTo.value;
  recognition: boolean;
  lacks: string[];
}

function heardAs(spoken: string, commands: SpeechView["commands"]): Abilities["listensTo"] {
  const phrase = (command: string) => commands[command]?.[0] ?? "";
  const said = { yes: phrase("yes"), no: phrase("no"), done: phrase("done"), cannot: phrase("cannot") };
  return { language: nameOf(spoken, language), ...said };
}

type OpenMicrophone = Microphone & { onFrame(pcm: ArrayBuffer): void };

async function abilitiesAndMicrophone(): Promise<[Abilities, string | null, OpenMicrophone | null]> {
  const abilities = await rest.speech().then(
    ({ voice, recognition, language: heard, commands }) => ({
      listensTo: heard === language ? null : heardAs(heard, commands),
      recognition: recognition.available,
      lacks: [
        ...(voice.available ? [] : [t("The service has no voice ({why_not}): questions are shown.", { why_not: voice.why_not ?? "" })]),
        ...(!voice.available || language === "en" || browserVoices().length > 0
          ? []
          : [t("This browser has no voice of your language: the service speaks English.")]),
        ...(recognition.available ? [] : [t("It cannot listen ({why_not}): please use the buttons.", { why_not: recognition.why_not ?? "" })]),
      ],
    }),
    (error: Error) => ({ listensTo: null, recognition: false, lacks: [whyNotDone(error)] }),
  );
  if (!abilities.recognition) return [abilities, null, null];
  const held = { onFrame: (_: ArrayBuffer) => undefined as void };
  try {
    const microphone = await openMicrophone((pcm) => held.onFrame(pcm));
    return [abilities, null, Object.assign(held, microphone)];
  } catch (error) {
    const why = (error as Error).message;
    return [abilities, t("The microphone cannot be used ({why}): please use the buttons.", { why }), null];
  }
}

/** Nobody is talked to of what another helper is asked, unless they have taken it. */
function isPutToMe(question: Question): boolean {
  return isTurnOf(helperName.value, question) || question.claimed_by === helperName.value;
}

class SpokenDialogue {
  readonly #socket: SpeechSocket | null;
  readonly #stops: (() => void)[];
  /** What is being talked about, so that nothing is said twice. */
  #about = "";
  #asked: Question | null = null;
  /** Counts what was begun to be said: only the last may tell the service that it was said. */
  #said = 0;

  constructor(listens: boolean) {
    speechPhase.value = "idle";
    this.#socket = listens
      ? connectSpeech(helperName.value, {
          open: () => this.#again(),
          message: (message) => void this.#receive(message),
          lost: () => this.#quiet(),
        })
      : null;
    this.#stops = [effect(() => this.#follow()), effect(() => this.#confirm()), onRepeat((question) => this.#repeat(question))];
  }

  hear(pcm: ArrayBuffer): void {
    this.#socket?.sound(pcm);
  }

  end(): void {
    for (const stop of this.#stops) stop();
    this.#said += 1;
    hush();
    this.#socket?.close();
  }

  /** Talk about what is shown: a question, or a statement in a dialogue that goes on. */
  #follow(): void {
    const question = shown.value;
    const prompt = question?.prompt ?? null;
    if (question !== null && prompt !== null && question.awaiting === "answer" && isPutToMe(question)) {
      const about = `${prompt.prompt} ${prompt.version}`;
      if (about === this.#about) return;
      this.#about = about;
      this.#asked = question;
      untracked(() => this.#ask(question));
      return;
    }
    this.#asked = null;
    const statement = newestStatement();
    if (statement === null) {
      this.#about = "";
      return;
    }
    this.#asked = statement.awaited;
    if (statement.about === this.#about) return;
    this.#about = statement.about;
    untracked(() => (statement.awaited === null ? void this.#say(statement.text, statement.audio) : this.#ask(statement.awaited)));
  }

  #ask(question: Question): void {
    lastHeard.value = null;
    const prompt = question.prompt;
    if (prompt === null) return;
    if (this.#socket?.open) {
      this.#socket.send({ type: "listen", dialogue: question.dialogue, prompt: prompt.prompt });
    } else {
      void this.#say(prompt.text, soundOf(question));
    }
  }

  #again(): void {
    const question = this.#asked;
    if (question !== null) this.#ask(question);
  }

  #repeat(question: Question): boolean {
    this.#ask(question);
    return true;
  }

  /** Say what a final answer will do while it can still be taken back. */
  #confirm(): void {
    const waiting = held.value;
    if (waiting === null) return;
    const address = soundOf(waiting.question);
    untracked(() => {
      this.#socket?.send({ type: "cancel" });
      const { reply } = waiting;
      void this.#say(waiting.effect, address === null || "way" in reply ? null : `${address}/${reply.answer}`);
    });
  }

  async #say(text: string, audio: string | null): Promise<boolean> {
    const mine = ++this.#said;
    speechPhase.value = "speaking";
    await say(text, audio);
    if (mine !== this.#said) return false;
    speechPhase.value = "idle";
    return true;
  }

  #quiet(): void {
    if (speechPhase.value !== "speaking") speechPhase.value = "idle";
  }

  async #receive(message: ToSpeaker): Promise<void> {
    switch (message.type) {
      case "say":
        if (await this.#say(message.text, message.audio)) this.#socket?.send({ type: "spoken" });
        return;
      case "listening":
      case "hearing":
        speechPhase.value = message.type;
        return;
      case "heard":
        lastHeard.value = { phrase: message.phrase };
        this.#take(message.command, message.way);
        return;
      case "gave_up":
        speechPhase.value = "gave_up";
        void rest.speech().then(({ phrases }) => this.#sayButtons(phrases.buttons));
        return;
      case "ended":
        if (message.reason !== "gave_up" && message.reason !== "replaced") this.#quiet();
        return;
      case "error":
        // Nothing to listen to: somebody was faster, or the service has too much to do.
        if (message.status === 503 && this.#asked !== null) {
          speechLacks.value = message.detail;
          void this.#say(this.#asked.prompt?.text ?? "", soundOf(this.#asked));
        }
        return;
    }
  }

  async #sayButtons(text: string | undefined): Promise<void> {
    if (text !== undefined && (await this.#say(text, rest.phraseSoundPath("buttons")))) speechPhase.value = "gave_up";
  }

  /** Act on a command as the same button would. */
  #take(command: Extract<ToSpeaker, { type: "heard" }>["command"], way: string | null): void {
    const question = this.#asked === null ? undefined : dialogueOf(this.#asked.dialogue);
    if (question === undefined || command === null) return;
    if (command === "done") sayOfHelp(question, "done");
    if (command === "cannot") sayOfHelp(question, "take_back");
    if (question.awaiting === "answer") actOn(question);
    if (way !== null) choose(question, way);
    else if (command === "yes" || command === "no") answer(question, command);
    if (command === "stop") {
      rest.pauseRun(question.run).then(
        () => tellEnding(question, t("You said stop: the run is paused.")),
        (error: Error) => tellEnding(question, t("You said stop, but: {message}", { message: whyNotDone(error) })),
      );
    }
  }
}

function soundOf(question: Question): string | null {
  return question.prompt === null ? null : rest.promptSoundPath(question.dialogue, question.prompt.prompt);
}

interface Statement {
  readonly about: string;
  readonly text: string;
  readonly audio: string | null;
  /** The dialogue in which help is awaited that this helper has promised. */
  readonly awaited: Question | null;
}

function newestStatement(): Statement | null {
  const waiting = awaitingHelp.value.find((each) => each.prompt?.kind === "say" && each.help?.helper === helperName.value);
  if (waiting?.prompt) {
    return { about: waiting.prompt.prompt, text: waiting.prompt.text, audio: soundOf(waiting), awaited: waiting };
  }
  const last = together.value.at(-1);
  if (last === undefined) return null;
  return { about: last.dialogue, text: last.text, audio: rest.promptSoundPath(last.dialogue, last.prompt), awaited: null };
}
