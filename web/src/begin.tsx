// The console itself, once it has its words: what stands in its modules is said in the reader's language.
import { render } from "preact";
import { App } from "./app/app";
import { followLinks } from "./app/router";
import { begin } from "./state/service";

followLinks(document);
render(<App />, document.getElementById("app") as HTMLElement);
void begin();
