// What people of one building have asked for that is not done yet.
import { expectation, isOver, STATUS_SIGNS, STATUS_WORDS, wanted } from "../requests/request_words";
import { clockOf } from "../requests/when";
import { useRequests } from "../requests/use_requests";
import { siteName } from "../run/run_words";
import type { SiteView } from "../wire/types";
import { t } from "../words/words";
import { HomeList } from "./home_list";

const AGAIN_MS = 10_000;

export function OpenRequests({ site }: { site: SiteView }) {
  const { requests, fleet } = useRequests(site.id, AGAIN_MS);
  const open = requests?.filter((each) => !isOver(each)) ?? [];
  if (open.length === 0) return null;
  return (
    <HomeList
      id={`home-requests-${site.id}`}
      title={t("Requests in {site}", { site: siteName(site) })}
      href="/requests"
      all={t("All requests")}
      items={open.map((each) => (
        <li key={each.name}>
          <span>{wanted(each)}</span>
          <span class="home-state">
            <span aria-hidden="true">{STATUS_SIGNS[each.status]}</span> {STATUS_WORDS[each.status]}
          </span>
          <span class="small quiet">{expectation(each, clockOf(site, fleet))}</span>
        </li>
      ))}
    />
  );
}
