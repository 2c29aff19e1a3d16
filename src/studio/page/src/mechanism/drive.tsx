// SPDX-License-Identifier: MIT
import {short} from "../numbers";
import type {Met} from "./answers";
import type {Desk} from "./desk";
import {useStore} from "./store";

const centre = 60, radius = 42;
const degrees = (angle: number) => angle * 180 / Math.PI;
const rounded = (value: number) => short(Number(value.toFixed(3)));

function onCircle(angle: number, at: number): [number, number] {
  return [centre + at * Math.cos(angle), centre - at * Math.sin(angle)];
}

/// What is met next on the way, and when.
function nextOf(events: Met[], time: number, span: number, closed: boolean): {met: Met; wait: number} | undefined {
  let next: {met: Met; wait: number} | undefined;
  const now = closed && span > 0 ? time % span : time;
  for (const met of events) {
    if (met.time === null || met.kind === "return") continue;
    const wait = met.time >= now ? met.time - now : closed ? met.time + span - now : Infinity;
    if (wait < (next?.wait ?? Infinity)) next = {met, wait};
  }
  return next;
}

/// Where the drive stands, with what it meets: a circle where it turns, a line where it moves a slide.
export function Drive({desk}: {desk: Desk}) {
  const {mechanism, position, events, from, to} = useStore(desk);
  if (!mechanism?.drive || !position) return null;
  const {name, slide} = mechanism.drive;
  const value = (drive: number) => (slide ? `${rounded(drive)} ${mechanism.unit}` : `${rounded(degrees(drive))}°`);
  const whole = !slide && to - from > 2 * Math.PI - 1e-6;
  const low = Math.min(from, ...(events ?? []).map(({drive}) => drive)), high = Math.max(to, ...(events ?? []).map(({drive}) => drive));
  const alongLine = (drive: number) => 10 + 280 * (high > low ? (drive - low) / (high - low) : 0.5);
  const kinds: Record<Met["kind"], string> = {limit: "▲", lost: "▲", change: "◆", infinity: "∞", return: "▽"};
  const next = events && nextOf(events, position.time, mechanism.span, mechanism.closed);
  const beyond = (events ?? []).filter((met) => met.time === null);
  const [x, y] = onCircle(position.drive, radius - 6);
  const [x1, y1] = onCircle(from, radius), [x2, y2] = onCircle(to, radius);
  return (
    <div class="drive">
      {slide ? (
        <svg viewBox="0 0 300 40" class="way" role="img" aria-label={`${name} stands at ${value(position.drive)}`}>
          <line x1={alongLine(from)} y1={24} x2={alongLine(to)} y2={24} class="track" />
          {(events ?? []).map((met) => <text class={`met ${met.kind}`} x={alongLine(met.drive)} y={14} text-anchor="middle">{kinds[met.kind]}<title>{met.what}, {name} = {value(met.drive)}</title></text>)}
          <circle cx={alongLine(position.drive)} cy={24} r={5} class="hand" />
        </svg>
      ) : (
        <svg viewBox="0 0 120 120" class="dial" role="img" aria-label={`${name} stands at ${value(position.drive)}`}>
          <circle cx={centre} cy={centre} r={radius} class={whole ? "track" : "track off"} />
          {!whole && events && <path class="track" d={`M${x1} ${y1}A${radius} ${radius} 0 ${to - from > Math.PI ? 1 : 0} 0 ${x2} ${y2}`} />}
          {(events ?? []).map((met) => {
            const [ex, ey] = onCircle(met.drive, radius + 10);
            return <text class={`met ${met.kind}`} x={ex} y={ey + 4} text-anchor="middle">{kinds[met.kind]}<title>{met.what}, {name} = {value(met.drive)}</title></text>;
          })}
          <line x1={centre} y1={centre} x2={x} y2={y} class="hand" />
          <circle cx={x} cy={y} r={4} class="hand" />
        </svg>
      )}
      <div class="drive-words">
        <p><b>{name}</b> = {value(position.drive)}</p>
        {!events ? <p class="quiet">what it meets is being looked for …</p>
          : next ? <p class="next">▲ {next.met.what}, at {value(next.met.drive)}, in {rounded(next.wait)} s</p>
          : <p class="next">it meets no dead centre{beyond.length > 0 ? ` from ${value(from)} to ${value(to)}, where it is swung` : " in its turn"}</p>}
        {events && events.length > 0 && <ul class="events" aria-label="What the drive meets">
          {events.map((met) => <li>{kinds[met.kind]} {value(met.drive)}: {met.what}{met.time === null ? " (outside the swing)" : ""}</li>)}
        </ul>}
      </div>
    </div>
  );
}
