// One list of the home page: the first few, and where the others are.
import type { ComponentChildren } from "preact";
import { t } from "../words/words";

const SHOWN_AT_MOST = 6;

export function HomeList(props: { id: string; title: string; href: string; all: string; items: readonly ComponentChildren[] }) {
  const { id, title, href, all, items } = props;
  const more = items.length - SHOWN_AT_MOST;
  return (
    <section class="panel home-list" aria-labelledby={id}>
      <h2 id={id}>{title}</h2>
      <ul>
        {items.slice(0, SHOWN_AT_MOST)}
      </ul>
      <p class="small">
        <a href={href}>{more > 0 ? t("{all}, with {more} more", { all, more }) : all}</a>
      </p>
    </section>
  );
}
