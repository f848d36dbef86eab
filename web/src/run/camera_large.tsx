// One camera as large as the window.
import type { ComponentChildren } from "preact";
import { useEffect, useRef } from "preact/hooks";
import { t } from "../words/words";

export function CameraLarge({ title, onClose, children }: { title: string; onClose: () => void; children: ComponentChildren }) {
  const dialog = useRef<HTMLDialogElement>(null);
  useEffect(() => dialog.current?.showModal(), []);
  return (
    <dialog ref={dialog} class="camera-large" aria-label={title} onClose={onClose}>
      <div class="camera-large-head">
        <h2>{title}</h2>
        <button type="button" class="button" onClick={() => dialog.current?.close()}>
          {t("Close")}
        </button>
      </div>
      {children}
    </dialog>
  );
}
