// A file of this device that is to be a robot's model: what it is sent as, and under which name.
import { t } from "../words/words";

const LARGEST_BYTES = 32 * 1024 * 1024;
const SENT_AS: Readonly<Record<string, string>> = { zip: "application/zip", urdf: "application/xml", xml: "application/xml" };

export const ACCEPTED = Object.keys(SENT_AS).map((ending) => `.${ending}`).join(",");

export interface ModelFile {
  readonly file: File;
  /** Its media type. */
  readonly type: string;
  /** What the model is called unless somebody says otherwise. */
  readonly name: string;
}

/** A file that is no model at all. */
export class NotAModel extends Error {}

/** Whether a name can stand in an address, as that of a model does. */
export const isName = (name: string) => !/^\.{1,2}$|\//.test(name);

/** Raises `NotAModel`. What is in it the service looks at. */
export function modelFileOf(file: File): ModelFile {
  const [, stem = "", ending = ""] = /^(.+)\.([^.]+)$/.exec(file.name) ?? [];
  const type = SENT_AS[ending.toLowerCase()];
  if (type === undefined) {
    throw new NotAModel(t("{name} is neither a ZIP with a robot.urdf and its meshes nor a URDF.", { name: file.name }));
  }
  if (file.size > LARGEST_BYTES) {
    throw new NotAModel(t("{name} is larger than 32 MiB; a robot's model may not be.", { name: file.name }));
  }
  return { file, type, name: stem };
}
