// Writes src/wire/types.ts from the service's own description of its wire, read from standard
// input as `mend schema console` prints it. A change of the protocol so breaks the build.
import { writeFile } from "node:fs/promises";
import { text } from "node:stream/consumers";
import { compile } from "json-schema-to-typescript";

// The service writes tuples as JSON Schema 2020-12 does, which the compiler does not know yet.
const schema = JSON.parse(await text(process.stdin), (_, value) => {
  if (!Array.isArray(value?.prefixItems)) return value;
  const { prefixItems, ...rest } = value;
  return { ...rest, items: prefixItems };
});
const source = await compile(schema, "Wire", {
  additionalProperties: false,
  bannerComment: "// Made from the service's schema by `make console`; not to be edited.",
  unreachableDefinitions: true,
  strictIndexSignatures: true,
});
await writeFile(new URL("../src/wire/types.ts", import.meta.url), source);
