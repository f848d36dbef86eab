// The helper's WebSocket: messages in order, commands with their results, and a connection that is
// made again after the last event seen, so that nothing is missed.
import { Refusal, Unreachable } from "./rest";
import type { Told } from "./told";
import type { FromHelper, SnapshotMessage, ToHelper } from "./types";

const FIRST_PAUSE_MS = 300;
const LONGEST_PAUSE_MS = 5_000;
const COMMAND_TIMEOUT_MS = 10_000;

export type ConnectionState = "connecting" | "connected" | "lost" | "closed";

export interface Receiver {
  /** The service's state at once; everything known before is replaced. */
  snapshot(snapshot: SnapshotMessage): void;
  event(event: Told): void;
  state(state: ConnectionState): void;
  /** Why the service cannot keep what happens, so that no run goes on; null once it can. */
  trouble(reason: string | null): void;
  /** Called before each new try; false gives up (the session has ended, say). */
  mayReconnect(): Promise<boolean>;
}

type Command<T = FromHelper> = T extends FromHelper ? Omit<T, "id"> : never;

interface Waiting {
  resolve(result: Record<string, unknown>): void;
  reject(error: Error): void;
  timer: number;
}

export class HelperSocket {
  #socket: WebSocket | null = null;
  #seen: number | null = null;
  #pause = FIRST_PAUSE_MS;
  #retry = 0;
  #nextId = 1;
  #closed = false;
  readonly #waiting = new Map<number, Waiting>();

  constructor(
    private readonly helper: string,
    private readonly receiver: Receiver,
    private readonly presence: () => string,
  ) {}

  connect(): void {
    this.receiver.state(this.#seen === null ? "connecting" : "lost");
    const socket = new WebSocket(this.#address());
    this.#socket = socket;
    socket.onmessage = (frame) => this.#receive(JSON.parse(frame.data as string) as ToHelper);
    socket.onclose = () => this.#lost();
  }

  close(): void {
    this.#closed = true;
    window.clearTimeout(this.#retry);
    this.#socket?.close();
    this.receiver.state("closed");
  }

  /** Try at once, when there is reason to think that the network is back. */
  hurry(): void {
    if (this.#socket !== null || this.#closed) return;
    window.clearTimeout(this.#retry);
    void this.#reconnect();
  }

  /** Give the service up now, as when the device says that it is offline. */
  drop(): void {
    this.#socket?.close();
  }

  /** Send a command; resolves with its result, rejects with a `Refusal` or `Unreachable`. */
  send(command: Command): Promise<Record<string, unknown>> {
    const socket = this.#socket;
    if (socket?.readyState !== WebSocket.OPEN) return Promise.reject(new Unreachable());
    const id = this.#nextId++;
    return new Promise((resolve, reject) => {
      const timer = window.setTimeout(() => this.#settle(id)?.reject(new Unreachable()), COMMAND_TIMEOUT_MS);
      this.#waiting.set(id, { resolve, reject, timer });
      socket.send(JSON.stringify({ ...command, id }));
    });
  }

  #address(): URL {
    const address = new URL("/ws/helper", location.href);
    address.protocol = address.protocol === "https:" ? "wss:" : "ws:";
    address.searchParams.set("helper", this.helper);
    address.searchParams.set("told", "true");
    address.searchParams.set("presence", this.presence());
    if (this.#seen !== null) address.searchParams.set("after", String(this.#seen));
    return address;
  }

  #receive(message: ToHelper): void {
    switch (message.type) {
      case "snapshot":
        this.#seen = message.seq;
        this.#pause = FIRST_PAUSE_MS;
        this.receiver.state("connected");
        this.receiver.trouble(null);
        this.receiver.snapshot(message);
        return;
      case "trouble":
        this.receiver.trouble(message.reason);
        return;
      case "result":
        this.#settle(message.id)?.resolve(message.result);
        return;
      case "error":
        this.#settle(message.id)?.reject(
          new Refusal(message.status, message.detail, message.errors ?? [], message.answered_by),
        );
        return;
      default:
        this.#seen = message.seq;
        // As was asked for in the address.
        this.receiver.event(message as Told);
    }
  }

  #settle(id: string | number | null): Waiting | null {
    const waiting = typeof id === "number" ? this.#waiting.get(id) : undefined;
    if (waiting === undefined) return null;
    this.#waiting.delete(id as number);
    window.clearTimeout(waiting.timer);
    return waiting;
  }

  #lost(): void {
    this.#socket = null;
    for (const id of [...this.#waiting.keys()]) this.#settle(id)?.reject(new Unreachable());
    if (this.#closed) return;
    this.receiver.state("lost");
    // Many consoles that lost the same service must not all come back at the same moment.
    const pause = this.#pause * (0.5 + Math.random() / 2);
    this.#pause = Math.min(this.#pause * 2, LONGEST_PAUSE_MS);
    this.#retry = window.setTimeout(() => void this.#reconnect(), pause);
  }

  async #reconnect(): Promise<void> {
    const may = await this.receiver.mayReconnect();
    if (this.#closed || this.#socket !== null) return;
    if (may) this.connect();
    else this.close();
  }
}
