// Where a task file is let in: dropped anywhere on the library, or chosen with a button.
import type { ComponentChildren } from "preact";
import { useState } from "preact/hooks";
import { t } from "../words/words";

interface DropZoneProps {
  onFile: (file: File) => void;
  onSeveral: () => void;
  children: ComponentChildren;
}

export function DropZone({ onFile, onSeveral, children }: DropZoneProps) {
  // Entering a child comes before leaving its parent, so they are counted.
  const [depth, setDepth] = useState(0);
  const enter = (event: DragEvent) => {
    if (!event.dataTransfer?.types.includes(t("Files"))) return;
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
      {depth > 0 && <p class="drop-here">{t("Drop the task file here")}</p>}
    </div>
  );
}

/** The same for those who do not drag. */
export function FileButton({ onFile }: { onFile: (file: File) => void }) {
  const choose = (event: Event) => {
    const input = event.currentTarget as HTMLInputElement;
    const file = input.files?.[0];
    // So that the same file can be chosen again after it was put right.
    input.value = "";
    if (file !== undefined) onFile(file);
  };
  return (
    <label class="button file-button">
      {t("Upload a file")}
      <input class="unseen" type="file" accept=".yaml,.yml,.json" onChange={choose} />
    </label>
  );
}
