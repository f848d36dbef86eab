// Giving back what the graphics card holds of a part of the scene.
import { Light, Material, type Object3D } from "three";

export function release(root: Object3D): void {
  root.traverse((each) => {
    const { geometry, material } = each as Partial<{ geometry: { dispose(): void }; material: unknown }>;
    geometry?.dispose();
    for (const used of [material].flat()) if (used instanceof Material) used.dispose();
    if (each instanceof Light) each.dispose();
  });
}
