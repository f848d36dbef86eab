/** Words of any script in names, which have Latin letters only: there they stand in Punycode (RFC 3492). */

const BASE = 36;
const FIRST = 128;
const DIGITS = "abcdefghijklmnopqrstuvwxyz0123456789";

/** A text with such names as they were written before; what begins with a digit has lost its beginning. */
export function asWritten(text: string): string {
  return text
    .replaceAll(/(?<![\w-])q0--(?=[0-9])/g, "")
    .replaceAll(/(?<![A-Za-z0-9])xn--([a-z0-9]+)([_-](?=[A-Za-z0-9]))?/g, (all, word: string, joined?: string) => {
      const written = decoded(word);
      if (written === null) return all;
      return joined === undefined ? written : `${written} `;
    });
}

/** The letters of a word without any of ASCII; null for what is none. */
function decoded(word: string): string | null {
  const letters: number[] = [];
  let [code, bias, at, place] = [FIRST, 72, 0, 0];
  while (at < word.length) {
    const before = place;
    for (let weight = 1, k = BASE; ; k += BASE) {
      const digit = DIGITS.indexOf(word[at++] ?? " ");
      if (digit < 0) return null;
      place += digit * weight;
      const threshold = Math.min(Math.max(k - bias, 1), 26);
      if (digit < threshold) break;
      weight *= BASE - threshold;
    }
    const count = letters.length + 1;
    bias = adapted(place - before, count, before === 0);
    code += Math.floor(place / count);
    if (code > 0x10ffff) return null;
    place %= count;
    letters.splice(place++, 0, code);
  }
  return String.fromCodePoint(...letters);
}

function adapted(delta: number, count: number, first: boolean): number {
  let left = first ? Math.floor(delta / 700) : Math.floor(delta / 2);
  left += Math.floor(left / count);
  let k = 0;
  for (; left > 455; k += BASE) left = Math.floor(left / 35);
  return k + Math.floor((36 * left) / (left + 38));
}
