// A menu of interventions, by pointer and by key.
import { useLayoutEffect, useRef } from "preact/hooks";
import type { Offer } from "./interventions";

interface Props {
  label: string;
  offers: readonly Offer[];
  style?: Record<string, string>;
  onChoose(offer: Offer): void;
  onClose(): void;
}

export function OfferMenu({ label, offers, style = {}, onChoose, onClose }: Props) {
  const menu = useRef<HTMLDivElement>(null);
  useLayoutEffect(() => {
    const before = document.activeElement;
    menu.current?.scrollIntoView({ block: "nearest" });
    itemsOf(menu.current)[0]?.focus({ preventScroll: true });
    const outside = ({ target }: PointerEvent) => {
      if (!menu.current?.contains(target as Node)) onClose();
    };
    document.addEventListener("pointerdown", outside, true);
    return () => {
      document.removeEventListener("pointerdown", outside, true);
      const mayReturn = document.activeElement === document.body || menu.current?.contains(document.activeElement);
      if (mayReturn && before instanceof HTMLElement) before.focus({ preventScroll: true });
    };
  }, []);
  const onKeyDown = (event: KeyboardEvent) => {
    const items = itemsOf(menu.current);
    const at = items.indexOf(document.activeElement as HTMLElement);
    const next = nextItem(event.key, at, items.length);
    if (next !== null) items[next]?.focus();
    else if (event.key === "Escape") onClose();
    else if (event.key === "Tab") return onClose();
    else return;
    event.preventDefault();
    event.stopPropagation();
  };
  return (
    <div ref={menu} class="scene-menu" role="menu" aria-label={label} style={style} onKeyDown={onKeyDown}>
      <p class="scene-menu-title" aria-hidden="true">
        {label}
      </p>
      {offers.map((offer) => (
        <button key={offer.label} type="button" class="bare" role="menuitem" tabIndex={-1} onClick={() => onChoose(offer)}>
          <span class="scene-menu-act">{offer.label}</span>
          <span class="small quiet">{offer.hint}</span>
        </button>
      ))}
    </div>
  );
}

function itemsOf(menu: HTMLElement | null): HTMLElement[] {
  return [...(menu?.querySelectorAll<HTMLElement>("[role=menuitem]") ?? [])];
}

function nextItem(key: string, at: number, count: number): number | null {
  switch (key) {
    case "ArrowDown":
      return (at + 1) % count;
    case "ArrowUp":
      return (at + count - 1) % count;
    case "Home":
      return 0;
    case "End":
      return count - 1;
    default:
      return null;
  }
}
