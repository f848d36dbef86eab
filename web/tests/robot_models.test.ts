// Which file is a robot's model, and which robots name it.
import { describe, expect, it } from "vitest";
import { isName, modelFileOf } from "../src/models/model_file";
import { missingModels, usersOf } from "../src/models/model_users";
import type { ModelView, RobotView } from "../src/wire/types";

const robot = (name: string, model: string | null) => ({ robot: name, model }) as RobotView;
const model = (name: string) => ({ name, built_in: false }) as ModelView;

describe("a file that is to be a model", () => {
  it("goes as what its name says, and is called as the file is", () => {
    expect(modelFileOf(new File([], "my.lamp.ZIP"))).toMatchObject({ type: "application/zip", name: "my.lamp" });
    expect(modelFileOf(new File([], "post.urdf"))).toMatchObject({ type: "application/xml", name: "post" });
  });

  it.each(["lamp", "lamp.dae", ".zip"])("is none where it is called %s", (name) => {
    expect(() => modelFileOf(new File([], name))).toThrow(`${name} is neither a ZIP`);
  });
});

describe("a name of a model", () => {
  it.each(["lamp", "my lamp", ".lamp", "a..b"])("may be %s", (name) => expect(isName(name)).toBe(true));
  it.each([".", "..", "a/b"])("cannot be %s", (name) => expect(isName(name)).toBe(false));
});

describe("robots and their models", () => {
  const robots = [robot("a", "lamp"), robot("b", "crane"), robot("c", "lamp"), robot("d", null), robot("e", "arm")];

  it("says who names a model", () => {
    expect(usersOf("lamp", robots)).toEqual(["a", "c"]);
    expect(usersOf("pr2", robots)).toEqual([]);
  });

  it("says which models nobody has given", () => {
    expect(missingModels([model("lamp")], robots)).toEqual(["arm", "crane"]);
  });
});
