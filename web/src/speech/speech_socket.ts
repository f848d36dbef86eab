// The WebSocket that carries one helper's microphone and what is heard.
import type { FromSpeaker, ToSpeaker } from "../wire/types";

const RETRY_MS = 2_000;
const SOUND_IS_MISSING = new ArrayBuffer(0);

export interface SpeechSocket {
  readonly open: boolean;
  send(message: FromSpeaker): void;
  sound(pcm: ArrayBuffer): void;
  close(): void;
}

/** Connect, and again whenever the connection is lost; `onOpen` comes each time. */
export function connectSpeech(
  helper: string,
  receive: { open(): void; message(message: ToSpeaker): void; lost(): void },
): SpeechSocket {
  const address = new URL("/ws/speech", location.href);
  address.protocol = address.protocol === "https:" ? "wss:" : "ws:";
  address.searchParams.set("helper", helper);
  let closed = false;
  let retry = 0;
  let skipped = false;
  let socket = connect();

  function connect(): WebSocket {
    const made = new WebSocket(address);
    skipped = false;
    made.onopen = () => receive.open();
    made.onmessage = (frame) => receive.message(JSON.parse(frame.data as string) as ToSpeaker);
    made.onclose = () => {
      if (closed) return;
      receive.lost();
      retry = window.setTimeout(() => {
        socket = connect();
      }, RETRY_MS);
    };
    return made;
  }

  return {
    get open() {
      return socket.readyState === WebSocket.OPEN;
    },
    send(message) {
      if (socket.readyState === WebSocket.OPEN) socket.send(JSON.stringify(message));
    },
    sound(pcm) {
      if (socket.readyState !== WebSocket.OPEN) return;
      // Sound that is late is of no use: a slow connection gets none, and is told so, rather than old sound.
      if (socket.bufferedAmount >= 64_000) {
        skipped = true;
        return;
      }
      if (skipped) socket.send(SOUND_IS_MISSING);
      skipped = false;
      socket.send(pcm);
    },
    close() {
      closed = true;
      window.clearTimeout(retry);
      socket.close();
    },
  };
}
