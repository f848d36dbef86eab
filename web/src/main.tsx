import "./design/tokens.css";
import "./design/base.css";
import "./design/controls.css";
import { loadAnsweringWords } from "./words/load";

void loadAnsweringWords().then(() => import("./begin"));
