// Who is signed in here, and what they may do. The service decides; this only spares people the attempt.
import { signal } from "@preact/signals";
import type { SessionView } from "../wire/types";
import { t } from "../words/words";

export type Role = NonNullable<SessionView["role"]>;

const PEOPLE: readonly Role[] = ["viewer", "helper", "operator", "admin"];

export const role = signal<Role | null>(null);
/** The name that goes with the token; null where everybody says what they are called. */
export const principal = signal<string | null>(null);

/** Whether whoever is signed in may do what needs a role. */
export function may(needed: Role): boolean {
  return role.value !== null && PEOPLE.indexOf(role.value) >= PEOPLE.indexOf(needed);
}

/** Why somebody may not do `what` ("Answering"), as one sentence. */
export function whyNot(what: string, needed: Role): string {
  return t("{what} needs the role {needed}; yours is {yours}.", { what, needed, yours: role.value ?? t("none") });
}
