import { render } from "preact";
import { App } from "./app/app";
import { followLinks } from "./app/router";
import "./design/tokens.css";
import "./design/base.css";
import "./design/controls.css";
import { begin } from "./state/service";

const root = document.getElementById("app") as HTMLElement;
followLinks(document);
render(<App />, root);
void begin();
