// A view whose code is loaded when it is first shown, so that the answering path stays small.
import { type ComponentType, createElement } from "preact";
import { useEffect, useState } from "preact/hooks";

export function later<P extends object>(load: () => Promise<ComponentType<P>>): ComponentType<P> {
  let loaded: ComponentType<P> | null = null;
  return function Later(props: P) {
    const [state, setState] = useState<"loading" | "ready" | "failed">(loaded ? "ready" : "loading");
    useEffect(() => {
      if (loaded !== null) return;
      load().then(
        (component) => {
          loaded = component;
          setState("ready");
        },
        () => setState("failed"),
      );
    }, []);
    if (loaded !== null) return createElement(loaded, props);
    if (state === "failed") return <p class="page">This view could not be loaded. Is the service there?</p>;
    return <p class="page quiet">Loading …</p>;
  };
}
