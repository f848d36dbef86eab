// Where a file is let in: dropped anywhere on a page, or chosen with a button.
import type { ComponentChildren } from "preact";
import { useState } from "preact/hooks";
import "./drop_zone.css";

/** What browsers call what is dragged. */
const FILES = "Files";

interface DropZoneProps {
  onFile: (file: File) => void;
  onSeveral: () => void;
  /** What stands on the page while a file is above it. */
  here: string;
  children: ComponentChildren;
}

export function DropZone({ onFile, onSeveral, here, children }: DropZoneProps) {
  // Entering a child comes before leaving its parent, so they are counted.
  const [depth, setDepth] = useState(0);
  const enter = (event: DragEvent) => {
    if (!event.dataTransfer?.types.includes(FILES)) return;
    event.preventDefault();
    setDepth((before) => before + 1);
  };
  const drop = (event: DragEvent) => {
    event.preventDefault();
    setDepth(0);
    const [file, another] = event.dataTransfer?.files ?? [];
    if (another !== undefined) onSeveral();
    else if (file !== undefined) onFile(file);
  };
  return (
    <div
      class={depth > 0 ? "drop-zone over" : "drop-zone"}
      onDragEnter={enter}
      onDragOver={(event) => event.preventDefault()}
      onDragLeave={() => setDepth((before) => Math.max(0, before - 1))}
      onDrop={drop}
    >
      {children}
      {depth > 0 && <p class="drop-here">{here}</p>}
    </div>
  );
}

interface FileButtonProps {
  onFile: (file: File) => void;
  /** Which files are offered, as `accept` of an input has them. */
  accept: string;
  children: ComponentChildren;
}

/** The same for those who do not drag. */
export function FileButton({ onFile, accept, children }: FileButtonProps) {
  const choose = (event: Event) => {
    const input = event.currentTarget as HTMLInputElement;
    const file = input.files?.[0];
    // So that the same file can be chosen again after it was put right.
    input.value = "";
    if (file !== undefined) onFile(file);
  };
  return (
    <label class="button file-button">
      {children}
      <input class="unseen" type="file" accept={accept} onChange={choose} />
    </label>
  );
}
