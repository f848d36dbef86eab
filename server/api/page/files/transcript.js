// One sentence per event for the transcript; null for those that nobody needs to read.

const SENTENCES = {
  run_started: (e) => `The run of ${e.tree_name} in ${e.world} begins.`,
  node_started: (e) => `${e.robot} starts ${e.name} (attempt ${e.attempt}).`,
  step_started: () => null,
  issue_raised: (e) => `${e.robot} noticed: ${e.issue}${e.object ? ` (${e.object})` : ""}.`,
  dialogue_opened: () => null,
  prompt: (e) => `${e.robot}: “${e.text}”${e.version > 1 ? " (asked again)" : ""}`,
  claimed: (e) => `${e.helper} is on it.`,
  released: (e) => `${e.helper} is no longer on it.`,
  answered: (e) => `${e.helper}: ${e.answer}.`,
  escalated: (e) => `Nobody answered; now asking ${e.to}${e.channel === "mail" ? " by e-mail" : ""}.`,
  help_awaited: (e) => `${e.robot} watches for the help that ${e.helper} promised.`,
  help_verified: (e) => `${e.robot} has seen the help.`,
  help_not_seen: (e) => `${e.robot} has not seen the help.`,
  resolved: (e) => `Resolved: ${e.resolution}.`,
  dialogue_closed: (e) => (e.reason === "resolved" ? null : `The dialogue ends: ${e.reason}.`),
  intervention: (e) =>
    `${e.by}: ${e.act}${e.object ? ` ${e.object}` : ""}${e.ok ? "" : ` (not possible: ${e.detail})`}.`,
  node_done: (e) => `${e.name} is done, by ${e.by}.`,
  node_reset: (e) => `${e.name} is put back: ${e.reason}.`,
  node_abandoned: (e) => `${e.name} is given up: ${e.reason}.`,
  run_paused: () => "The run is paused.",
  run_resumed: () => "The run goes on.",
  run_finished: () => "The run is finished.",
  run_failed: (e) => `The run has failed: ${e.reason}.`,
  run_aborted: (e) => `The run is aborted${e.reason ? `: ${e.reason}` : ""}.`,
  robot_lost: (e) => `${e.robot} is lost: ${e.reason}.`,
  robot_back: (e) => `${e.robot} is back.`,
  robot_holding: () => null,
  robot_resumed: () => null,
};

export function sentence(event) {
  const words = SENTENCES[event.type];
  return words ? words(event) : event.type;
}
