// The languages of the console: English, which it is written in, and each that has a folder of texts.
import { readdirSync } from "node:fs";

export const LANGUAGES = ["en", ...readdirSync(new URL("texts", import.meta.url)).sort()];
