// The connection that brings a run's poses as they are: the latest counts, what was missed does not.
import type { Layout } from "../../wire/types";
import { decodeFrame, type Frame } from "./decode";

const FIRST_PAUSE_MS = 300;
const LONGEST_PAUSE_MS = 5_000;
const THE_END = 1000;
const POLICY_VIOLATION = 1008;

/** `ended`: the run is over; `refused`: the service will not show it, however often it is asked. */
export type WatchState = "connecting" | "watching" | "lost" | "ended" | "refused";

export interface Watcher {
  layout(layout: Layout): void;
  frame(frame: Frame): void;
  state(state: WatchState): void;
}

/** Watch a run until it ends; returns how to stop. */
export function watchRun(run: string, helper: string, watcher: Watcher): () => void {
  let socket: WebSocket | null = null;
  let pause = FIRST_PAUSE_MS;
  let retry = 0;
  let stopped = false;

  const connect = () => {
    socket = new WebSocket(addressOf(run, helper));
    socket.binaryType = "arraybuffer";
    socket.onmessage = ({ data }: MessageEvent<string | ArrayBuffer>) => {
      if (stopped) return;
      if (typeof data !== "string") watcher.frame(decodeFrame(data));
      else if (isLayout(data)) {
        pause = FIRST_PAUSE_MS;
        watcher.state("watching");
        watcher.layout(JSON.parse(data) as Layout);
      }
    };
    socket.onclose = ({ code }) => {
      if (stopped) return;
      if (code === THE_END) watcher.state("ended");
      else if (code === POLICY_VIOLATION) watcher.state("refused");
      else {
        watcher.state("lost");
        // Many consoles that lost the same service must not all come back at the same moment.
        retry = window.setTimeout(connect, pause * (0.5 + Math.random() / 2));
        pause = Math.min(pause * 2, LONGEST_PAUSE_MS);
      }
    };
  };

  watcher.state("connecting");
  connect();
  return () => {
    stopped = true;
    window.clearTimeout(retry);
    socket?.close();
  };
}

function addressOf(run: string, helper: string): URL {
  const address = new URL("/ws/live", location.href);
  address.protocol = address.protocol === "https:" ? "wss:" : "ws:";
  address.searchParams.set("run", run);
  address.searchParams.set("helper", helper);
  return address;
}

function isLayout(text: string): boolean {
  return (JSON.parse(text) as { type: string }).type === "layout";
}
