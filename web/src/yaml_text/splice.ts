// Changing a text at a few spots, and what lines and columns these are in.

/** What stands from `from` to `to` is replaced. */
export interface Splice {
  from: number;
  to: number;
  insert: string;
}

/** A text after splices that do not overlap; what is inserted where something goes stands before it. */
export function spliced(text: string, splices: readonly Splice[]): string {
  const last = [...splices].sort((a, b) => b.from - a.from || b.to - a.to);
  return last.reduce((before, { from, to, insert }) => before.slice(0, from) + insert + before.slice(to), text);
}

export function lineStart(text: string, offset: number): number {
  return text.lastIndexOf("\n", offset - 1) + 1;
}

/** Behind the line break that ends the line of an offset, or the end of the text. */
export function lineEnd(text: string, offset: number): number {
  const end = text.indexOf("\n", offset);
  return end < 0 ? text.length : end + 1;
}

export function columnOf(text: string, offset: number): number {
  return offset - lineStart(text, offset);
}

/** Whether nothing but space stands before an offset in its line. */
export function beginsLine(text: string, offset: number): boolean {
  return text.slice(lineStart(text, offset), offset).trim() === "";
}

/** Lines farther to the right, or (below 0) to the left as far as there is space. */
export function shifted(lines: string, by: number): string {
  if (by === 0) return lines;
  if (by > 0) return lines.replace(/^(?=.*\S)/gm, " ".repeat(by));
  return lines.replace(new RegExp(`^ {1,${-by}}`, "gm"), "");
}

/** Where the line begins that counts so from 1. */
export function offsetOfLine(text: string, line: number): number {
  let offset = 0;
  for (let at = 1; at < line && offset < text.length; at++) offset = lineEnd(text, offset);
  return offset;
}
