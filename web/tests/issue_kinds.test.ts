// Kinds of issue in the reader's language, and back where somebody looks for one.
import { afterEach, describe, expect, it } from "vitest";
import { issueKind, issueMeant } from "../src/words/issue_kinds";
import { said, takeSentences } from "../src/words/said";

afterEach(() => takeSentences({}, {}));

describe("a kind of issue", () => {
  it("is called as the service calls it where no language says it", () => {
    expect(issueKind("door_closed")).toBe("door closed");
  });

  it("is said in the reader's language, in sentences too", () => {
    takeSentences({}, { "door closed": "Tür zu", "issue: {issue} in step {step}": "Störung: {issue} bei Schritt {step}" });
    expect(issueKind("door_closed")).toBe("Tür zu");
    expect(said("issue: door_closed in step 3")).toBe("Störung: Tür zu bei Schritt 3");
    expect(issueKind("of_somebody_else")).toBe("of somebody else");
  });

  it("is found by the words that are shown", () => {
    takeSentences({}, { "door closed": "Tür zu" });
    expect(issueMeant(" tür zu", ["missed", "door_closed"])).toBe("door closed");
    expect(issueMeant("green leg", ["missed", "door_closed"])).toBe("green leg");
  });
});
