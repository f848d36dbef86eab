// A question before something that cannot be taken back.
import type { ComponentChildren } from "preact";
import { useEffect, useId, useRef } from "preact/hooks";
import { t } from "../words/words";
import "./confirm.css";

interface ConfirmProps {
  title: string;
  children: ComponentChildren;
  /** What the button says that does it. */
  confirm: string;
  cancel?: string;
  /** It harms nothing. */
  harmless?: boolean;
  onConfirm: () => void;
  onCancel: () => void;
}

export function Confirm({ title, children, confirm, cancel = t("Cancel"), harmless = false, onConfirm, onCancel }: ConfirmProps) {
  const dialog = useRef<HTMLDialogElement>(null);
  const id = useId();
  useEffect(() => dialog.current?.showModal(), []);
  const refuse = (event: Event) => {
    event.preventDefault();
    onCancel();
  };
  return (
    <dialog class="confirm" ref={dialog} aria-labelledby={id} onCancel={refuse}>
      <h2 id={id}>{title}</h2>
      <div>{children}</div>
      <div class="confirm-buttons">
        <button class="button" type="button" onClick={onCancel}>
          {cancel}
        </button>
        <button class={`button ${harmless ? "primary" : "danger"}`} type="button" onClick={onConfirm}>
          {confirm}
        </button>
      </div>
    </dialog>
  );
}
