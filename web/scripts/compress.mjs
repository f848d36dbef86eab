// Puts a compressed copy beside each file of the built page, for the service to send.
import { readdir, readFile, writeFile } from "node:fs/promises";
import { gzipSync } from "node:zlib";

const built = new URL("../../server/api/console/built/", import.meta.url);
for (const name of await readdir(built, { recursive: true })) {
  if (!/\.(js|css|html|svg|webmanifest)$/.test(name)) continue;
  const file = new URL(name, built);
  await writeFile(new URL(`${file}.gz`), gzipSync(await readFile(file), { level: 9 }));
}
