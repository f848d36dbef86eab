// A button to say something; it is there where the browser recognizes speech on this device.
import { useEffect, useRef, useState } from "preact/hooks";
import { canHear, ENGLISH, hear } from "./browser_ear";
import { t } from "../words/words";

interface SpeakButtonProps {
  label: string;
  /** What is spoken. */
  language?: string;
  heard: (words: string) => void;
}

export function SpeakButton({ label, language = ENGLISH, heard }: SpeakButtonProps) {
  const [can, setCan] = useState(false);
  const [listening, setListening] = useState(false);
  const [failure, setFailure] = useState("");
  const stop = useRef<AbortController | null>(null);
  useEffect(() => {
    void canHear(language).then(setCan);
    return () => stop.current?.abort();
  }, []);
  if (!can) return null;
  const listen = async () => {
    // What is being read aloud would be heard too.
    if ("speechSynthesis" in window) speechSynthesis.cancel();
    const controller = new AbortController();
    stop.current = controller;
    setListening(true);
    setFailure("");
    try {
      const words = await hear(controller.signal, language);
      if (controller.signal.aborted) return;
      if (words === "") setFailure(t("I have heard nothing: say it once more, or type it."));
      else heard(words);
    } catch (error) {
      setFailure(error instanceof Error ? error.message : String(error));
    } finally {
      setListening(false);
    }
  };
  return (
    <div class="speak">
      <button
        class="button"
        type="button"
        aria-pressed={listening}
        onClick={() => (listening ? stop.current?.abort() : void listen())}
      >
        {listening ? t("Listening …") : label}
      </button>
      <p class="mistake small" role="alert">
        {failure}
      </p>
    </div>
  );
}
