// What the service or a robot says: where there is only the English text, screen readers are told so.
import { language } from "./language";
import { translated } from "./said";

export function Told({ text }: { text: string }) {
  const found = translated(text);
  if (found !== null || language === "en" || text === "") return <>{found ?? text}</>;
  return <span lang="en">{text}</span>;
}
