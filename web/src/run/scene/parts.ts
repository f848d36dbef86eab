// The objects in the scene: boxes with their knobs, where a frame says, with an outline round one of them.
import { BackSide, BoxGeometry, Color, Group, Mesh, MeshBasicMaterial, MeshLambertMaterial, SRGBColorSpace } from "three";
import type { ObjectLayout } from "../../wire/types";
import type { Frame } from "./decode";
import type { Palette } from "./palette";
import { setPose } from "./poses";

const OUTLINE_M = 0.008;

export interface Part {
  readonly layout: ObjectLayout;
  readonly root: Group;
  readonly rim: Group;
}

export interface Parts {
  readonly root: Group;
  readonly all: readonly Part[];
  show(frame: Frame): void;
  highlight(name: string | null): void;
  paint(palette: Palette): void;
}

export function createParts(objects: readonly ObjectLayout[]): Parts {
  const rim = new MeshBasicMaterial({ side: BackSide });
  const all = objects.map((each) => createPart(each, rim));
  const root = new Group();
  root.add(...all.map((each) => each.root));
  return {
    root,
    all,
    show(frame) {
      for (const [index, { root: drawn }] of all.entries()) {
        const shown = frame.objects[index];
        drawn.visible = shown !== undefined && !shown.gone && !shown.hidden;
        if (shown !== undefined) setPose(drawn, shown.pose);
      }
    },
    highlight(name) {
      for (const each of all) each.rim.visible = each.layout.name === name;
    },
    paint(palette) {
      rim.color.copy(palette.accent);
    },
  };
}

function createPart(layout: ObjectLayout, rimMaterial: MeshBasicMaterial): Part {
  // Linear by the document, but the cameras show the numbers as they are; the two must look alike.
  const material = new MeshLambertMaterial({ color: new Color().setRGB(...layout.color, SRGBColorSpace) });
  const [root, rim] = [new Group(), new Group()];
  let bottom = 0;
  for (const size of [layout.size_m, layout.knob_m]) {
    if (size === null) continue;
    const body = new Mesh(new BoxGeometry(...size), material);
    const edge = new Mesh(new BoxGeometry(...size.map((each) => each + OUTLINE_M)), rimMaterial);
    body.position.z = edge.position.z = bottom + size[2] / 2;
    body.castShadow = body.receiveShadow = true;
    root.add(body);
    rim.add(edge);
    bottom += size[2];
  }
  rim.visible = false;
  root.visible = false;
  root.add(rim);
  return { layout, root, rim };
}
