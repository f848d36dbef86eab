// Meshes of a model, by how their files are called.
import { Group, type LoadingManager, type Material, Mesh, type Object3D } from "three";
import { ColladaLoader } from "three/addons/loaders/ColladaLoader.js";
import { STLLoader } from "three/addons/loaders/STLLoader.js";
import { toCreasedNormals } from "three/addons/utils/BufferGeometryUtils.js";

const CREASE_RAD = 0.6;

/** Whether a mesh of this name may have colours of its own. */
export function hasOwnColors(url: string): boolean {
  return kindOf(url) === "dae";
}

/** Load a mesh; what has no colours of its own is of the `material`. */
export async function loadMesh(url: string, manager: LoadingManager, material: Material): Promise<Object3D> {
  switch (kindOf(url)) {
    case "dae":
      return (await new ColladaLoader(manager).loadAsync(url))?.scene ?? new Group();
    case "obj": {
      const { OBJLoader } = await import("three/addons/loaders/OBJLoader.js");
      const loaded = await new OBJLoader(manager).loadAsync(url);
      loaded.traverse((each) => {
        if (each instanceof Mesh) each.material = material;
      });
      return loaded;
    }
    default: {
      const geometry = await new STLLoader(manager).loadAsync(url);
      return new Mesh(toCreasedNormals(geometry, CREASE_RAD), material);
    }
  }
}

function kindOf(url: string): string {
  return url.slice(url.lastIndexOf(".") + 1).toLowerCase();
}
