// What the service or a robot says: where there is only the English text, screen readers are told so.
import { sentence } from "../run/run_words";
import { language } from "./language";
import { translated, translatedReason } from "./said";
import { t } from "./words";

export function Told({ text }: { text: string }) {
  const found = translated(text);
  if (found !== null || language === "en" || text === "") return <>{found ?? text}</>;
  return <span lang="en">{text}</span>;
}

/** Why a fleet does something, as a sentence. */
export function ToldReason({ text }: { text: string }) {
  const found = translatedReason(text);
  if (found !== null || language === "en") return <>{sentence(found ?? text)}</>;
  return <span lang="en">{sentence(text)}</span>;
}

/** What is said between quotation marks, which are of the reader's language whatever the text is in. */
export function Quoted({ text }: { text: string }) {
  const [before, after] = t("“{text}”", { text: "\n" }).split("\n");
  return (
    <>
      {before}
      <Told text={text} />
      {after}
    </>
  );
}
