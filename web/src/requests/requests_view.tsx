// What people of a building have asked its robots for, and how far that is.
import { signal } from "@preact/signals";
import { useState } from "preact/hooks";
import { siteName } from "../run/run_words";
import { may, whyNot } from "../state/access";
import * as rest from "../wire/rest";
import type { RequestView, SiteView } from "../wire/types";
import { fleets } from "./fleets";
import { Followed } from "./followed";
import { expectation, isOver, STATUS_SIGNS, STATUS_WORDS, wanted } from "./request_words";
import { followed, type RequestDocument, useAsking } from "./use_asking";
import { useKinds } from "./use_kinds";
import { clockOf, type SiteClock } from "./when";
import { Waits } from "./waits";
import { useRequests } from "./use_requests";
import { WishForm } from "./wish_form";
import { whyNotDone } from "../words/said";
import { t } from "../words/words";
import { ToldReason } from "../words/told";
import "./requests.css";

/** Whose robots are asked, where several sites take requests. */
const chosen = signal("");

export function RequestsView() {
  const sites = fleets.value;
  const site = sites?.find(({ id }) => id === chosen.value) ?? sites?.[0];
  return (
    <section class="page">
      <div class="page-head">
        <h1>{t("Requests")}</h1>
        {sites !== null && sites.length > 1 && site !== undefined && <SiteChoice sites={sites} site={site} />}
      </div>
      {sites === null && <p class="quiet">{t("Loading …")}</p>}
      {sites !== null && site === undefined && <NobodyTakesAny />}
      {site !== undefined && <OfSite key={site.id} site={site} />}
    </section>
  );
}

function SiteChoice({ sites, site }: { sites: readonly SiteView[]; site: SiteView }) {
  return (
    <div class="field">
      <label for="requests-site">{t("Building")}</label>
      <select id="requests-site" value={site.id} onChange={(event) => (chosen.value = event.currentTarget.value)}>
        {sites.map((each) => (
          <option key={each.id} value={each.id}>
            {siteName(each)}
          </option>
        ))}
      </select>
    </div>
  );
}

export function NobodyTakesAny() {
  return (
    <div class="panel empty">
      <h2>{t("No robots take requests")}</h2>
      <p class="quiet">{t("Robots of a building do, once it is opened as a site with a fleet:")}{" "}<code>mend site open SCENE --world building --fleet live</code>.
      </p>
    </div>
  );
}

function OfSite({ site }: { site: SiteView }) {
  const { requests, fleet, failure, again } = useRequests(site.id);
  const { asking, ask, forget } = useAsking(site.id);
  const kinds = useKinds(site.id, fleet?.robots[0]?.robot);
  const clock = clockOf(site, fleet);
  const mine = followed(asking, requests);
  const askAndRead = (request: RequestDocument) => ask(request).then(again);
  const open = requests?.filter((each) => !isOver(each)) ?? [];
  const over = requests?.filter(isOver).reverse() ?? [];
  return (
    <>
      <p class="mistake" role="alert">
        {failure}
      </p>
      {mine !== null && clock !== null && <Followed request={mine} clock={clock} changed={again} />}
      {fleet !== null && clock !== null && may("helper") && (
        <WishForm fleet={fleet} kinds={kinds} clock={clock} asking={asking} ask={askAndRead} forget={forget} />
      )}
      {fleet !== null && !may("helper") && <p class="quiet">{whyNot(t("Asking for something"), "helper")}</p>}
      {requests === null && failure === "" && <p class="quiet">{t("Loading …")}</p>}
      {requests !== null && (
        <>
          <h2>{t("Open")}</h2>
          {open.length === 0 && <p class="quiet">{t("Nothing is asked for just now.")}</p>}
          <RequestList label={t("Open requests")} requests={open} clock={clock} changed={again} />
          {over.length > 0 && <h2>{t("Over")}</h2>}
          <RequestList label={t("Requests that are over")} requests={over} clock={clock} changed={again} />
        </>
      )}
    </>
  );
}

interface ListProps {
  label: string;
  requests: readonly RequestView[];
  /** At the moment that is shown; null until it is known. */
  clock: SiteClock | null;
  /** Something was cancelled; unset where nothing can be, as of the past. */
  changed?: () => void;
}

export function RequestList({ label, requests, clock, changed }: ListProps) {
  if (requests.length === 0) return null;
  return (
    <ul class="requests" aria-label={label}>
      {requests.map((each) => (
        <Row key={each.name} request={each} clock={clock} changed={changed} />
      ))}
    </ul>
  );
}

function Row({ request, clock, changed }: { request: RequestView; clock: SiteClock | null; changed: (() => void) | undefined }) {
  const [failure, setFailure] = useState("");
  const cancel = () =>
    rest.cancelRequest(request.site, request.name).then(changed, (error: Error) => setFailure(whyNotDone(error)));
  const { status, reason } = request;
  return (
    <li class="request">
      <span class={`badge request-${status}`}>
        <span aria-hidden="true">{STATUS_SIGNS[status]}</span>
        {STATUS_WORDS[status]}
      </span>
      <span class="request-wanted">
        <strong>{wanted(request)}</strong>
        <span class="small quiet">{expectation(request, clock)}</span>
        <Waits request={request} />
        {reason !== null && <span class="small"><ToldReason text={reason} /></span>}
        {failure !== "" && (
          <span class="mistake small" role="alert">
            {failure}
          </span>
        )}
      </span>
      {changed !== undefined && !isOver(request) && status !== "returning" && may("helper") && (
        <button class="button" type="button" aria-label={t("Cancel: {request}", { request: wanted(request) })} onClick={() => void cancel()}>{t("Cancel")}</button>
      )}
    </li>
  );
}
