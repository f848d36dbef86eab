// The lines of a task tree: numbered arrows under a THEN, a brace under an AND, a fork under an OR.
import type { Edge, TreeLayout } from "./layout";

const NUMBER_RADIUS = 9;
/** Less room before a child leaves none for its number. */
const NUMBER_ROOM = 24;

export function Edges({ edges, direction }: { edges: readonly Edge[]; direction: TreeLayout["direction"] }) {
  return (
    <g aria-hidden="true">
      {edges.map(({ from, to }) => (
        <g key={to.node.path} class={`edge ${from.node.kind} ${taken(to.node.state) ? "taken" : ""}`}>
          <path d={direction === "across" ? across(from, to) : down(from, to)} />
          {from.node.kind === "then" && to.x - from.x >= NUMBER_ROOM && <Place to={to} />}
        </g>
      ))}
    </g>
  );
}

function taken(state: string | null): boolean {
  return state === "active" || state === "in_dialogue" || state === "done";
}

function Place({ to }: { to: Edge["to"] }) {
  const y = to.y + to.height / 2;
  return (
    <>
      <circle cx={to.x - NUMBER_RADIUS - 3} cy={y} r={NUMBER_RADIUS} />
      <text x={to.x - NUMBER_RADIUS - 3} y={y + 4}>
        {to.position}
      </text>
    </>
  );
}

function across(from: Edge["from"], to: Edge["to"]): string {
  const x = from.x + from.width;
  const y = from.y + from.height / 2;
  const end = to.y + to.height / 2;
  const middle = (x + to.x) / 2;
  switch (from.node.kind) {
    case "and":
      return `M${x} ${y}H${middle}V${end}H${to.x}`;
    case "or":
      return `M${x} ${y}h6L${to.x - 6} ${end}H${to.x}`;
    default:
      return `M${x} ${y}C${middle} ${y} ${middle} ${end} ${to.x} ${end}`;
  }
}

function down(from: Edge["from"], to: Edge["to"]): string {
  const x = from.x + Math.min((to.x - from.x) / 2, 10) + (from.node.kind === "or" ? 6 : 0);
  return `M${x} ${from.y + from.height}V${to.y + to.height / 2}H${to.x}`;
}
