// A text area for a task file, with line numbers, marks at wrong lines, and a light tint.
//
// The text area is as large as its text, and so are the layers under it: one element scrolls them
// all, and they cannot get out of step. Of the layers only what is near the window is drawn.
import type { RefObject } from "preact";
import { useEffect, useLayoutEffect, useMemo, useRef, useState } from "preact/hooks";
import { tint } from "./yaml_tint";
import "./text_editor.css";

const LINE_PX = 24;
const LINES_AROUND = 40;
const LEADING_SPACE = /^[ ]*(?:- )?/;

/** A line to go to, counted from 1; a new object goes there again. */
export interface Jump {
  line: number;
}

/** A place between two characters of the text. */
export interface Caret {
  offset: number;
}

interface TextEditorProps {
  id: string;
  label: string;
  text: string;
  onText: (text: string) => void;
  /** The lines with mistakes, counted from 1. */
  wrong: ReadonlySet<number>;
  describedBy: string;
  jump: Jump | null;
  /** Where to go on writing after something was undone; a new object goes there again. */
  caret: Caret | null;
  onUndo: () => void;
  onRedo: () => void;
}

export function TextEditor(props: TextEditorProps) {
  const { id, label, text, onText, wrong, describedBy, jump, caret } = props;
  const frame = useRef<HTMLDivElement>(null);
  const area = useRef<HTMLTextAreaElement>(null);
  const lines = useMemo(() => text.split("\n"), [text]);
  const [first, last] = useLinesInSight(frame, lines.length);
  const height = lines.length * LINE_PX;
  useFit(area, text, height);
  useJump(frame, area, lines, jump);
  useCaret(area, caret);
  const shown = lines.slice(first, last);
  return (
    <div class="text-editor" ref={frame}>
      <div class="text-editor-numbers" aria-hidden="true" style={{ height, minWidth: `${String(lines.length).length + 4}ch` }}>
        <ol style={{ transform: `translateY(${first * LINE_PX}px)` }}>
          {shown.map((_, index) => (
            <li key={first + index} class={wrong.has(first + index + 1) ? "wrong" : ""}>
              {first + index + 1}
            </li>
          ))}
        </ol>
      </div>
      <div class="text-editor-text">
        <pre aria-hidden="true" style={{ transform: `translateY(${first * LINE_PX}px)` }}>
          {shown.map((line, index) => (
            <Line key={first + index} line={line} wrong={wrong.has(first + index + 1)} />
          ))}
        </pre>
        <textarea
          id={id}
          ref={area}
          aria-label={label}
          aria-describedby={describedBy}
          aria-invalid={wrong.size > 0}
          value={text}
          wrap="off"
          spellcheck={false}
          autocapitalize="off"
          autocomplete="off"
          onInput={(event) => onText(event.currentTarget.value)}
          onBeforeInput={(event) => undoneByBrowser(event, props)}
          onKeyDown={keepIndentation}
        />
      </div>
    </div>
  );
}

function Line({ line, wrong }: { line: string; wrong: boolean }) {
  const pieces = useMemo(() => tint(line), [line]);
  return (
    <div class={wrong ? "line wrong" : "line"}>
      {pieces.map(({ ink, text }, index) => (
        <span key={index} class={ink}>
          {text}
        </span>
      ))}
    </div>
  );
}

function useLinesInSight(frame: RefObject<HTMLDivElement | null>, count: number): [number, number] {
  const [sight, setSight] = useState({ top: 0, height: 800 });
  useEffect(() => {
    const element = frame.current as HTMLDivElement;
    const look = () => setSight({ top: element.scrollTop, height: element.clientHeight });
    const resized = new ResizeObserver(look);
    resized.observe(element);
    element.addEventListener("scroll", look, { passive: true });
    return () => {
      resized.disconnect();
      element.removeEventListener("scroll", look);
    };
  }, []);
  const first = Math.max(0, Math.floor(sight.top / LINE_PX) - LINES_AROUND);
  return [first, Math.min(count, Math.ceil((sight.top + sight.height) / LINE_PX) + LINES_AROUND)];
}

const FITS_ITSELF = CSS.supports("field-sizing", "content");

/** Where the browser does not, make the text area as large as its text. */
function useFit(area: RefObject<HTMLTextAreaElement | null>, text: string, height: number): void {
  useLayoutEffect(() => {
    if (FITS_ITSELF) return;
    const element = area.current as HTMLTextAreaElement;
    element.style.height = `${height}px`;
    element.style.width = "0";
    element.style.width = `max(100%, ${element.scrollWidth}px)`;
  }, [text, height]);
}

function useJump(
  frame: RefObject<HTMLDivElement | null>,
  area: RefObject<HTMLTextAreaElement | null>,
  lines: readonly string[],
  jump: Jump | null,
): void {
  useEffect(() => {
    if (jump === null) return;
    const line = Math.min(jump.line, lines.length) - 1;
    const begin = lines.slice(0, line).reduce((sum, each) => sum + each.length + 1, 0);
    const element = area.current as HTMLTextAreaElement;
    element.focus({ preventScroll: true });
    element.setSelectionRange(begin, begin + (lines[line] ?? "").length);
    const scrolling = frame.current as HTMLDivElement;
    scrolling.scrollTo({ top: line * LINE_PX - scrolling.clientHeight / 2, left: 0 });
    scrolling.scrollIntoView({ block: "nearest" });
  }, [jump]);
}

/** After something was undone with the keys: the browser would go to the end of the text. */
function useCaret(area: RefObject<HTMLTextAreaElement | null>, caret: Caret | null): void {
  useLayoutEffect(() => {
    const element = area.current as HTMLTextAreaElement;
    if (caret !== null && document.activeElement === element) element.setSelectionRange(caret.offset, caret.offset);
  }, [caret]);
}

/** The browser's own undo, as of a menu, knows nothing of what was done in the drawing. */
function undoneByBrowser(event: InputEvent, { onUndo, onRedo }: Pick<TextEditorProps, "onUndo" | "onRedo">): void {
  if (event.inputType !== "historyUndo" && event.inputType !== "historyRedo") return;
  event.preventDefault();
  if (event.inputType === "historyUndo") onUndo();
  else onRedo();
}

/** Begin a new line where the last one began. Tab is left alone: it leaves the text. */
function keepIndentation(event: KeyboardEvent): void {
  if (event.key !== "Enter" || event.isComposing || event.ctrlKey || event.metaKey || event.altKey) return;
  const { value, selectionStart } = event.currentTarget as HTMLTextAreaElement;
  const line = value.slice(value.lastIndexOf("\n", selectionStart - 1) + 1, selectionStart);
  const indentation = (LEADING_SPACE.exec(line)?.[0] ?? "").replace("-", " ");
  if (indentation === "") return;
  event.preventDefault();
  // Put in as if it were typed, and told of as that.
  document.execCommand("insertText", false, `\n${indentation}`);
}
