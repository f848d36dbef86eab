// How new values are written into a YAML text.
import { Document, isCollection, visit } from "yaml";

const WRITTEN = { lineWidth: 0, flowCollectionPadding: false } as const;
const LONGEST_FLOW = 100;

/** A value in one line, as it can stand behind a key or in a list in brackets. */
export function inLine(value: unknown, json: boolean): string {
  if (json) return JSON.stringify(value);
  // In brackets, so that what means something there is quoted.
  const doc = new Document([value]);
  visit(doc, { Collection: (_, node) => void (node.flow = true) });
  return String(doc.toString(WRITTEN)).trim().slice(1, -1).trim();
}

/** One item of a list, written in lines from the left edge on; what is short and flat in one. */
export function itemInLines(value: unknown): string {
  const doc = new Document([value]);
  visit(doc, {
    Map: (_, node) => {
      const flat = !node.items.some((pair) => isCollection(pair.value));
      if (flat && inLine(node.toJS(doc), false).length <= LONGEST_FLOW) node.flow = true;
    },
  });
  return doc.toString(WRITTEN);
}

/** Whether two values are the same, whatever the order of their keys. */
export function sameValue(one: unknown, other: unknown): boolean {
  if (Object.is(one, other)) return true;
  if (Array.isArray(one) && Array.isArray(other)) {
    return one.length === other.length && one.every((each, index) => sameValue(each, other[index]));
  }
  if (!isRecord(one) || !isRecord(other)) return false;
  const keys = Object.keys(one);
  return keys.length === Object.keys(other).length && keys.every((key) => key in other && sameValue(one[key], other[key]));
}

export function isRecord(value: unknown): value is Record<string, unknown> {
  return typeof value === "object" && value !== null && !Array.isArray(value);
}

