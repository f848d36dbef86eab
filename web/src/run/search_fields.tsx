// The fields of a search: words, and from which day to which.
import { ANYTHING, isAnything, type Search } from "./search";
import { t } from "../words/words";
import "./search_fields.css";

interface SearchFieldsProps {
  search: Search;
  /** What the words may be of. */
  hint: string;
  onSearch: (search: Search) => void;
  children?: preact.ComponentChildren;
}

export function SearchFields({ search, hint, onSearch, children }: SearchFieldsProps) {
  const set = (name: keyof Search) => (event: Event) =>
    onSearch({ ...search, [name]: (event.currentTarget as HTMLInputElement).value });
  return (
    <search class="search">
      <div class="field search-text">
        <label for="search-text">{t("Search")}</label>
        <input id="search-text" type="search" maxLength={200} placeholder={hint} value={search.text} onInput={set("text")} />
      </div>
      <div class="field">
        <label for="search-from">{t("From")}</label>
        <input id="search-from" type="date" max={search.to} value={search.from} onInput={set("from")} />
      </div>
      <div class="field">
        <label for="search-to">{t("To")}</label>
        <input id="search-to" type="date" min={search.from} value={search.to} onInput={set("to")} />
      </div>
      {children}
      <button class="button" type="button" disabled={isAnything(search)} onClick={() => onSearch(ANYTHING)}>
        {t("Clear")}
      </button>
    </search>
  );
}
