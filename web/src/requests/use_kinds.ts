// What kinds of things the robots of a site may be asked for.
import { useEffect, useState } from "preact/hooks";
import * as rest from "../wire/rest";
import type { RequestKind } from "../wire/types";

/** Any of its robots tells; empty until it has. */
export function useKinds(site: string, robot: string | undefined): readonly RequestKind[] {
  const [kinds, setKinds] = useState<readonly RequestKind[]>([]);
  useEffect(() => {
    if (robot === undefined) return undefined;
    let current = true;
    rest.askedRobot(site, robot).then(
      (found) => current && setKinds(found.kinds),
      () => undefined,
    );
    return () => {
      current = false;
    };
  }, [site, robot]);
  return kinds;
}
