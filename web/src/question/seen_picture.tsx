// A camera's picture, with what the robot looks for drawn on it.
import { useState } from "preact/hooks";
import type { Detection } from "../wire/types";
import { DetectionOverlay } from "./detection_overlay";
import "./fault_picture.css";

interface Props {
  source: string;
  alt: string;
  /** What is drawn on it; nothing where it is null. */
  detection: Detection | null;
  /** When that was, on the picture. */
  moment: string;
  /** The pixels that a detection counts, where none is drawn. */
  size?: Detection["size_px"];
}

export function SeenPicture({ source, alt, detection, moment, size = detection?.size_px ?? null }: Props) {
  const [natural, setNatural] = useState<{ width: number; height: number } | null>(null);
  const measure = (event: Event) => {
    const { naturalWidth: width, naturalHeight: height } = event.currentTarget as HTMLImageElement;
    if (natural?.width !== width || natural.height !== height) setNatural({ width, height });
  };
  return (
    <div class="fault-picture">
      <img
        src={source}
        alt={alt}
        // Room for it before it is there, so that nothing moves away from under a finger.
        width={size?.[0]}
        height={size?.[1]}
        onLoad={measure}
      />
      {detection !== null && natural !== null && <DetectionOverlay detection={detection} size={natural} />}
      <span class="fault-moment">{moment}</span>
    </div>
  );
}
