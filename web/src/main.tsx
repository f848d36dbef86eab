import { loadAnsweringWords } from "./words/load";
import "./design/tokens.css";
import "./design/base.css";
import "./design/controls.css";

void loadAnsweringWords().then(() => import("./begin"));
