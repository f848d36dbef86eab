// A task file's text cut into pieces that are drawn in different inks.

export type Ink = "plain" | "key" | "goal" | "text" | "value" | "comment" | "sign";

export interface Piece {
  ink: Ink;
  text: string;
}

const GOALS = new Set(["then", "and", "or"]);

const PIECE = new RegExp(
  [
    /(?<comment>(?<=^|\s)#.*)/,
    /(?<key>"(?:[^"\\]|\\.)*"|'(?:[^']|'')*'|[A-Za-z_][\w-]*)(?=\s*:(?:\s|$))/,
    /(?<text>"(?:[^"\\]|\\.)*"?|(?<=^|[\s[{,:])'(?:[^']|'')*'?)/,
    /(?<value>(?<=^\s*|[:,[{-]\s*)(?:true|false|null|~|[-+]?\d[\d.eE+-]*)(?=\s*(?:[,\]}]|$|\s#)))/,
    /(?<sign>[-[\]{},:?|>&*](?=\s|$)|[[\]{},])/,
  ]
    .map((each) => each.source)
    .join("|"),
  "gu",
);

/**
 * The pieces of one line; together they are the line.
 *
 * Lines are looked at one by one, so that only those in sight cost anything: a text over several
 * lines is drawn as plain.
 */
export function tint(line: string): Piece[] {
  const pieces: Piece[] = [];
  let end = 0;
  for (const match of line.matchAll(PIECE)) {
    if (match.index > end) pieces.push({ ink: "plain", text: line.slice(end, match.index) });
    pieces.push({ ink: inkOf(match), text: match[0] });
    end = match.index + match[0].length;
  }
  if (end < line.length) pieces.push({ ink: "plain", text: line.slice(end) });
  return pieces;
}

function inkOf({ 0: found, groups = {} }: RegExpMatchArray): Ink {
  if (groups.key !== undefined) return GOALS.has(found) ? "goal" : "key";
  if (groups.comment !== undefined) return "comment";
  if (groups.text !== undefined) return "text";
  return groups.value !== undefined ? "value" : "sign";
}
