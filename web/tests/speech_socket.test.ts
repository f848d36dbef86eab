// What is sent of the microphone where the connection is slow.
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { connectSpeech } from "../src/speech/speech_socket";

class SlowSocket {
  static readonly OPEN = 1;
  static made: SlowSocket[] = [];
  readyState = SlowSocket.OPEN;
  bufferedAmount = 0;
  onopen: (() => void) | null = null;
  onclose: (() => void) | null = null;
  readonly sent: number[] = [];

  constructor(readonly address: URL) {
    SlowSocket.made.push(this);
  }

  send(pcm: ArrayBuffer) {
    this.sent.push(pcm.byteLength);
  }

  close() {}
}

const nothing = { open() {}, message() {}, lost() {} };

beforeEach(() => {
  SlowSocket.made = [];
  vi.useFakeTimers();
  vi.stubGlobal("WebSocket", SlowSocket);
  vi.stubGlobal("location", { href: "http://127.0.0.1:8330/", protocol: "http:" });
  vi.stubGlobal("window", globalThis);
});

afterEach(() => {
  vi.unstubAllGlobals();
  vi.useRealTimers();
});

describe("the microphone over a slow connection", () => {
  it("is told where sound is missing, once, before what comes after it", () => {
    const speech = connectSpeech("anna", nothing);
    const socket = SlowSocket.made[0]!;
    speech.sound(new ArrayBuffer(640));
    socket.bufferedAmount = 64_000;
    for (let frame = 0; frame < 3; frame += 1) speech.sound(new ArrayBuffer(640));
    expect(socket.sent).toEqual([640]);
    socket.bufferedAmount = 63_999;
    for (let frame = 0; frame < 2; frame += 1) speech.sound(new ArrayBuffer(640));
    expect(socket.sent).toEqual([640, 0, 640, 640]);
  });

  it("tells of no gap of a connection that has gone", () => {
    const speech = connectSpeech("anna", nothing);
    const gone = SlowSocket.made[0]!;
    gone.bufferedAmount = 64_000;
    speech.sound(new ArrayBuffer(640));
    gone.readyState = 3;
    gone.onclose?.();
    vi.runAllTimers();
    speech.sound(new ArrayBuffer(640));
    expect(SlowSocket.made[1]!.sent).toEqual([640]);
    expect(gone.sent).toEqual([]);
  });
});
