// What stands still in the scene: the table, and the outlines of the places on it.
import {
  BoxGeometry,
  BufferGeometry,
  Float32BufferAttribute,
  Group,
  LineBasicMaterial,
  LineLoop,
  Mesh,
  MeshLambertMaterial,
} from "three";
import type { Layout, ObjectLayout, PlaceLayout } from "../../wire/types";
import type { Palette } from "./palette";

const TOP_M = 0.04;
const LEG_M = 0.05;
const LEG_INSET_M = 0.06;
const ABOVE_TABLE_M = 0.002;
const UNKNOWN_FOOTPRINT_M = [0.08, 0.08] as const;

export interface Furniture {
  readonly root: Group;
  /** What can be pointed at to put something there. */
  readonly top: Mesh;
  paint(palette: Palette): void;
}

export function createFurniture({ table, places, objects }: Layout): Furniture {
  const wood = new MeshLambertMaterial();
  const ink = new LineBasicMaterial();
  const root = new Group();
  const [width, depth] = table.size_m;
  const top = new Mesh(new BoxGeometry(width, depth, TOP_M), wood);
  top.position.set(...table.center, table.height_m - TOP_M / 2);
  root.add(top, ...createLegs(table, wood));
  for (const each of root.children) {
    each.castShadow = true;
    each.receiveShadow = true;
  }
  for (const place of places) root.add(createOutline(place, objects, ink));
  return {
    root,
    top,
    paint(palette) {
      wood.color.copy(palette.table);
      ink.color.copy(palette.outline);
    },
  };
}

function createLegs({ center, size_m, height_m }: Layout["table"], wood: MeshLambertMaterial): Mesh[] {
  const length = height_m - TOP_M;
  const geometry = new BoxGeometry(LEG_M, LEG_M, length);
  return [-1, 1].flatMap((x) =>
    [-1, 1].map((y) => {
      const leg = new Mesh(geometry, wood);
      const [aside, along] = [size_m[0] / 2 - LEG_INSET_M, size_m[1] / 2 - LEG_INSET_M];
      leg.position.set(center[0] + x * aside, center[1] + y * along, length / 2);
      return leg;
    }),
  );
}

/** The footprint of the object that belongs there, as far as names tell. */
function createOutline(place: PlaceLayout, objects: readonly ObjectLayout[], ink: LineBasicMaterial): LineLoop {
  const size = objects.find((each) => each.name === place.name)?.size_m ?? UNKNOWN_FOOTPRINT_M;
  const [x, y] = [size[0] / 2, size[1] / 2];
  const corners = [-x, -y, 0, x, -y, 0, x, y, 0, -x, y, 0];
  const geometry = new BufferGeometry().setAttribute("position", new Float32BufferAttribute(corners, 3));
  const outline = new LineLoop(geometry, ink);
  outline.position.set(place.position[0], place.position[1], place.position[2] + ABOVE_TABLE_M);
  outline.rotation.z = place.yaw;
  return outline;
}
