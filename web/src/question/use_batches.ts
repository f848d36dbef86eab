// The queue as the service has it, read anew whenever a question comes, changes or goes.
import { useEffect, useState } from "preact/hooks";
import { questions } from "../state/questions";
import * as rest from "../wire/rest";
import type { QuestionBatchView } from "../wire/types";

/** What happens at once is read once. */
const SETTLED_MS = 100;

export function useBatches(): readonly QuestionBatchView[] {
  const [batches, setBatches] = useState<readonly QuestionBatchView[]>([]);
  const open = questions.value;
  useEffect(() => {
    let current = true;
    const read = () => void rest.questionBatches().then((found) => current && setBatches(found), () => undefined);
    const timer = window.setTimeout(read, SETTLED_MS);
    return () => {
      current = false;
      window.clearTimeout(timer);
    };
  }, [open]);
  return batches;
}
