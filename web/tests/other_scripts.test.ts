// Names have Latin letters only, and are shown in those in which they were written.
import { expect, test } from "vitest";
import { spoken } from "../src/question/fault_words";

test.each([
  ["q0--3_boxes--73d06a5d", "3 boxes"],
  ["q0--12345678--73d06a5d", "12345678"],
  ["xn--h1add2c8a-k--0afba7d8", "ключи k"],
  ["xn--h1aados_xn--h1ae7bxa--73d06a5d", "синий ящик"],
  ["q0--3_xn--90aoebsan-k", "3 коробки k"],
  ["xn--3e0bk47br7k_xn--hg4bo8j", "한국어 상자"],
  ["xn--j2bd4cyah0f_xn--11b4aya5ed-k", "हिन्दी किताब k"],
  ["cup_of_tea--0afba7d8", "cup of tea"],
])("the name %s is shown as %s", (name, shown) => {
  expect(spoken(name)).toBe(shown);
});

test("what is no such word stays", () => {
  expect(spoken("xn--99999999999")).toBe("xn  99999999999");
});
