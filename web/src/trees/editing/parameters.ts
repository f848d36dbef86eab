// The parameters of a behavior as fields of a form, from its JSON Schema.
import { isRecord } from "../../yaml_text/values";

export interface Parameter {
  key: string;
  required: boolean;
  kind: "text" | "number" | "truth" | "choice" | "other";
  /** Of a choice. */
  choices: readonly string[];
  min: number | null;
  max: number | null;
}

/** What any leaf may say, whatever its behavior: the level of autonomy that it needs. */
export const AUTONOMY: Parameter = {
  key: "autonomy",
  required: false,
  kind: "choice",
  choices: ["low", "high", "full"],
  min: null,
  max: null,
};

type Schema = Readonly<Record<string, unknown>>;

export function parametersOf(schema: Schema): Parameter[] {
  const required = new Set(Array.isArray(schema.required) ? schema.required : []);
  const properties = isRecord(schema.properties) ? schema.properties : {};
  return Object.entries(properties).map(([key, value]) => {
    const said = shapeOf(value, schema);
    return {
      key,
      required: required.has(key),
      kind: kindOf(said),
      choices: Array.isArray(said.enum) ? said.enum.map(String) : [],
      min: typeof said.minimum === "number" ? said.minimum : null,
      max: typeof said.maximum === "number" ? said.maximum : null,
    };
  });
}

/** What a parameter is besides null, which is the same as saying nothing. */
function shapeOf(value: unknown, schema: Schema): Schema {
  if (!isRecord(value)) return {};
  if (typeof value.$ref === "string") return shapeOf(referred(value.$ref, schema), schema);
  if (!Array.isArray(value.anyOf)) return value;
  const shapes = value.anyOf.map((each) => shapeOf(each, schema)).filter(({ type }) => type !== "null");
  return shapes.length === 1 ? (shapes[0] as Schema) : {};
}

function referred(reference: string, schema: Schema): unknown {
  const name = reference.split("/").at(-1) as string;
  return isRecord(schema.$defs) ? schema.$defs[name] : null;
}

function kindOf({ type, enum: choices }: Schema): Parameter["kind"] {
  if (Array.isArray(choices) && choices.every((each) => typeof each === "string")) return "choice";
  if (type === "string") return "text";
  if (type === "number" || type === "integer") return "number";
  return type === "boolean" ? "truth" : "other";
}

/** What a field says of its parameter; undefined where it says nothing. Raises `SyntaxError` for what is no JSON. */
export function valueOf({ kind }: Parameter, entered: string): unknown {
  if (entered.trim() === "") return undefined;
  switch (kind) {
    case "number":
      return Number.isFinite(Number(entered)) ? Number(entered) : entered;
    case "truth":
      return entered === "true";
    case "other":
      return JSON.parse(entered);
    default:
      return entered;
  }
}

/** What a field shows of a value. */
export function enteredOf({ kind }: Parameter, value: unknown): string {
  if (value === undefined || value === null) return "";
  return kind === "other" || typeof value === "object" ? JSON.stringify(value) : String(value);
}
