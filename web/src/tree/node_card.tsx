// The card of one node: its shape tells the kind, its sign and word the state.
import type { PlacedNode } from "./layout";
import { BreakpointSign, KindSign, StateSign } from "./signs";
import type { NodeKind, TreeNode } from "./tree_node";
import { KIND_RULES, KIND_WORDS, plain, shortened, stateWord, withoutRun } from "./words";
import { decimal, t } from "../words/words";

const NAME_PX = 7.6;
const SMALL_PX = 6.6;
const KIND_PX = 10.6;
const POINT = 14;
const METER_WIDTH = 44;

interface CardProps {
  placed: PlacedNode;
  /** The highest potential in the tree, which fills its meter. */
  highest: number;
  compact: boolean;
}

export function NodeCard({ placed, highest, compact }: CardProps) {
  const { node, width, height } = placed;
  return (
    <>
      <path class="outline" d={outline(node.kind, width, height)} />
      {node.kind === "and" && <path class="outline inner" d={`M5 1v${height - 2}M${width - 5} 1v${height - 2}`} />}
      {node.kind === "behavior" ? (
        <LeafText node={node} width={width} compact={compact} />
      ) : (
        <GoalText node={node} kind={node.kind} width={width} compact={compact} />
      )}
      {!compact && node.level !== null && node.potential !== null && (
        <Meters
          level={node.level}
          potential={node.potential}
          highest={highest}
          x={width - 2 * METER_WIDTH - (node.kind === "behavior" ? 18 : 22)}
        />
      )}
      {node.steered?.breakpoint === true && <BreakpointSign waits={node.steered.waits} y={height / 2} />}
      <path class="ring" d={outline(node.kind, width, height)} />
    </>
  );
}

/** A pointed card for THEN, one with double sides for AND, one pointed on both sides for OR. */
export function outline(kind: NodeKind, width: number, height: number): string {
  const middle = height / 2;
  switch (kind) {
    case "then":
      return `M0 0H${width - POINT}L${width} ${middle}L${width - POINT} ${height}H0Z`;
    case "and":
      return `M0 0H${width}V${height}H0Z`;
    case "or":
      return `M${POINT} 0H${width - POINT}L${width} ${middle}L${width - POINT} ${height}H${POINT}L0 ${middle}Z`;
    case "behavior": {
      const r = 10;
      const across = width - 2 * r;
      const down = height - 2 * r;
      return (
        `M${r} 0h${across}a${r} ${r} 0 0 1 ${r} ${r}v${down}a${r} ${r} 0 0 1 ${-r} ${r}` +
        `h${-across}a${r} ${r} 0 0 1 ${-r} ${-r}v${-down}a${r} ${r} 0 0 1 ${r} ${-r}z`
      );
    }
  }
}

function LeafText({ node, width, compact }: { node: TreeNode; width: number; compact: boolean }) {
  const left = node.state === null ? 12 : 36;
  const aside = compact ? null : asideOf(node);
  const room = width - left - 10 - (aside === null ? 0 : aside.length * SMALL_PX + 8);
  return (
    <>
      {node.state !== null && <StateSign state={node.state} x={10} y={compact ? 6 : 9} />}
      <text class="name" x={left} y={compact ? 21 : 24}>
        {shortened(plain(node.name), Math.floor(room / NAME_PX))}
      </text>
      {aside !== null && (
        <text class="aside" x={width - 10} y={24}>
          {aside}
        </text>
      )}
      {!compact && (
        <text class="word" x={left} y={44}>
          {node.state === null ? plain(node.behavior ?? "") : stateWord(node, node.state)}
        </text>
      )}
    </>
  );
}

function asideOf(node: TreeNode): string | null {
  if (node.owner !== null) return shortened(withoutRun(node.owner), 12);
  return node.attempts > 0 ? t("{count} failed", { count: node.attempts }) : null;
}

type GoalKind = Exclude<NodeKind, "behavior">;

function GoalText(props: { node: TreeNode; kind: GoalKind; width: number; compact: boolean }) {
  const { node, kind, width, compact } = props;
  const left = kind === "or" ? 16 : 10;
  const word = KIND_WORDS[kind];
  const y = compact ? 21 : 24;
  const nameLeft = left + 24 + word.length * KIND_PX + 6;
  const right = node.state === null ? 20 : 40;
  const room = Math.floor((width - nameLeft - right) / NAME_PX);
  const named = node.name !== kind;
  return (
    <>
      <KindSign kind={kind} x={left} y={y - 15} />
      <text class="kind-word" x={left + 24} y={y}>
        {word}
      </text>
      {named && (
        <text class="name" x={nameLeft} y={y}>
          {shortened(plain(node.name), room)}
        </text>
      )}
      {!compact && node.state === null && (
        <text class="word" x={left + 24} y={44}>
          {KIND_RULES[kind]}
        </text>
      )}
      {node.state !== null && <StateSign state={node.state} x={width - 36} y={y - 15} />}
    </>
  );
}

function Meters(props: { level: number; potential: number; highest: number; x: number }) {
  const { level, potential, highest, x } = props;
  return (
    <>
      <Meter kind="level" sign="↓" value={level} full={1} x={x} />
      <Meter kind="potential" sign="↑" value={potential} full={highest} x={x + METER_WIDTH + 8} />
    </>
  );
}

function Meter(props: { kind: string; sign: string; value: number; full: number; x: number }) {
  const { kind, sign, value, full, x } = props;
  const filled = full > 0 ? Math.min(value / full, 1) * METER_WIDTH : 0;
  return (
    <g class={`meter ${kind}`}>
      <text x={x} y={43}>
        {sign} {figure(value)}
      </text>
      <rect class="track" x={x} y={48} width={METER_WIDTH} height={4} rx={2} />
      {filled > 0 && <rect class="filled" x={x} y={48} width={filled} height={4} rx={2} />}
    </g>
  );
}

function figure(value: number): string {
  if (value === 0) return "0";
  if (value < 0.01) return "<.01";
  return decimal(value, value < 100 ? 2 : 0);
}
