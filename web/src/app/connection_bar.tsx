// Says calmly that the connection is lost, since when, and that nothing is lost with it; or that the
// service cannot keep what happens, so that the robots hold.
import { hurry, lostSince, trouble } from "../state/service";

const CLOCK = new Intl.DateTimeFormat("en-GB", { timeStyle: "medium" });

export function ConnectionBar() {
  const since = lostSince.value;
  return (
    <div class="connection-bar" role="status">
      {since !== null && (
        <p>
          <strong>No connection since {CLOCK.format(since)}.</strong> Nothing is lost: the service keeps every
          question, and this page catches up by itself.
        </p>
      )}
      {since === null && trouble.value !== null && (
        <p>
          <strong>The robots are told to hold: {trouble.value}.</strong> Everything goes on by itself once it can be.
        </p>
      )}
      {since !== null && (
        <button class="button" type="button" onClick={hurry}>
          Try now
        </button>
      )}
    </div>
  );
}
