// A view whose code is loaded when it is first shown, so that the answering path stays small.
import { type ComponentType, createElement } from "preact";
import { useEffect, useState } from "preact/hooks";
import { t } from "../words/words";
import { loadOtherWords } from "../words/load";

/**
 * `words` brings what the view says, where the answering path does not say it already. `aside`: nothing is in its
 * place until it is there, as it stands below what people have come for.
 */
export function later<P extends object>(
  load: () => Promise<ComponentType<P>>,
  words: () => Promise<void> = loadOtherWords,
  aside = false,
): ComponentType<P> {
  let loaded: ComponentType<P> | null = null;
  return function Later(props: P) {
    const [state, setState] = useState<"loading" | "ready" | "failed">(loaded ? "ready" : "loading");
    useEffect(() => {
      if (loaded !== null) return;
      // What stands in its modules is said in words that have to be there first.
      words().then(load).then(
        (component) => {
          loaded = component;
          setState("ready");
        },
        () => setState("failed"),
      );
    }, []);
    if (loaded !== null) return createElement(loaded, props);
    if (aside) return null;
    if (state === "failed") return <p class="page">{t("This view could not be loaded. Is the service there?")}</p>;
    return <p class="page quiet">{t("Loading …")}</p>;
  };
}
