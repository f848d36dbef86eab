// The editor of a scene's file: text, mistakes and the scene from above side by side.
import { DocumentEditor } from "../document/document_editor";
import type { DocumentKind } from "../document/document_kind";
import * as rest from "../wire/rest";
import { SceneSide } from "./scene_side";
import { t } from "../words/words";

const NEW_SCENE = `name: my_scene
objects:
  red_box:
    color: [0.9, 0.1, 0.1]   # linear red, green, blue
    size: [0.04, 0.06, 0.05] # x, y, z in metres
    pose: {x: 0.5, y: -0.4}
places:
  red_box: {pose: {x: 0.5, y: 0.0}}
`;

const SCENE: DocumentKind = {
  said: t("scene"),
  newName: "my_scene",
  newText: NEW_SCENE,
  textLabel: t("The file of the scene"),
  draftOf: (name) => `scene:${name ?? ""}`,
  addressOf: () => "/scenes",
  list: rest.scenes,
  read: rest.scene,
  check: rest.checkScene,
  save: rest.saveScene,
};

export function SceneEditor({ scene }: { scene: string | null }) {
  return <DocumentEditor kind={SCENE} name={scene} drawing={(editing) => <SceneSide editing={editing} />} />;
}
