// The models of robots over REST; apart from the rest, as nobody needs them to answer a question.
import { call, segment } from "../wire/rest";
import type { ModelView } from "../wire/types";
import type { ModelFile } from "./model_file";

/** Where a model is, which is also where an uploaded one is fetched as a ZIP. */
export const modelPath = (name: string) => `/api/models/${segment(name)}`;

export const models = () => call<ModelView[]>("GET", "/api/models");
export const keepModel = (name: string, { file, type }: ModelFile) => call<ModelView>("PUT", modelPath(name), file, { type });
export const deleteModel = (name: string) => call<void>("DELETE", modelPath(name));
