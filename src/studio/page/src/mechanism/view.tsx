// SPDX-License-Identifier: MIT
import {useRef, useState} from "preact/hooks";

import {rough, short} from "../numbers";
import type {Desk} from "./desk";
import {useStore} from "./store";

const reach = 26;  // of the pointer, in the picture [px]

/// The mechanism, exact in grey and as the machine has it over it; its joints are dragged.
export function LinkageView({desk}: {desk: Desk}) {
  const {mechanism, position, dragging, magnification, locked} = useStore(desk);
  const overlay = useRef<SVGSVGElement>(null);
  const [joint, setJoint] = useState("");
  if (!mechanism) return null;
  const {points} = mechanism;
  const movable = points.filter(({fixed}) => !(locked && fixed)).map(({name}) => name);
  const chosen = movable.includes(joint) ? joint : movable[0] ?? "";

  const placeOf = (event: PointerEvent): [number, number] => {
    const at = new DOMPoint(event.clientX, event.clientY).matrixTransform(overlay.current!.getScreenCTM()!.inverse());
    return [at.x, at.y];
  };
  const nearest = ([x, y]: [number, number]): string => {
    let best = "", least = reach;
    for (const name of movable) {
      const at = desk.placeOf(name);
      const away = at ? Math.hypot(at[0] - x, at[1] - y) : Infinity;
      if (away < least) [best, least] = [name, away];
    }
    return best;
  };
  const down = (event: PointerEvent) => {
    const point = nearest(placeOf(event));
    if (point === "" || desk.now.dragging) return;
    event.preventDefault();
    overlay.current!.setPointerCapture(event.pointerId);
    setJoint(point);
    void desk.take(point);
  };
  const move = (event: PointerEvent) => {
    const at = placeOf(event);
    if (desk.now.dragging) desk.drag(...at);  // also before what is drawn knows of it
    else if (event.pointerType === "mouse") overlay.current!.style.cursor = nearest(at) ? "grab" : "";
  };
  const keys = (event: KeyboardEvent) => {
    const far = event.shiftKey ? 20 : 4;
    const way = ({ArrowLeft: [-far, 0], ArrowRight: [far, 0], ArrowUp: [0, -far], ArrowDown: [0, far]} as Record<string, [number, number]>)[event.key];
    if (!way || chosen === "") return;
    event.preventDefault();
    void desk.nudge(chosen, ...way);
  };
  const marked = dragging ? [dragging.x, dragging.y] as const : undefined;
  const view = `0 0 ${mechanism.width} ${mechanism.height}`;
  const open = position?.status === "open";
  const error = position?.away;

  return (
    <div class="picture linkage">
      <div class="layers">
        <div dangerouslySetInnerHTML={{__html: mechanism.svg}} />
        <svg ref={overlay} class="moving" viewBox={view} role="application" tabindex={0}
          aria-label={`Mechanism: joint ${chosen}, moved by the arrow keys; ${locked ? "the mechanism follows" : "the lengths change"}`}
          onPointerDown={down} onPointerMove={move} onPointerUp={() => void desk.drop()} onPointerCancel={() => void desk.drop()} onKeyDown={keys}>
          <g class={dragging?.svg ? "left-behind" : ""} dangerouslySetInnerHTML={{__html: position?.svg ?? ""}} />
          {dragging?.svg && <g class="wanted" dangerouslySetInnerHTML={{__html: dragging.svg}} />}
          {marked && <circle class="hold" cx={marked[0]} cy={marked[1]} r={11} />}
        </svg>
      </div>
      <div class="linkage-line">
        <label>error × <input type="range" aria-label="Magnification of the error, a power of ten" min={0} max={6} step={0.1} value={Math.log10(magnification)}
          onInput={(event) => desk.magnify(10 ** Number((event.target as HTMLInputElement).value))} /> <output>{rough(magnification)}</output></label>
        <button disabled={!position?.suggested} onClick={() => desk.magnify(Math.min(1e6, Math.max(1, position?.suggested ?? 1)))}>fit</button>
        <output class="error" aria-label="Error of the machine">{open ? "cannot be assembled here" : error === undefined ? "" : `error ${rough(error)} ${mechanism.unit}${error > 0 ? ` at ${position!.worst}` : ""}`}</output>
      </div>
      <div class="linkage-line">
        <label><input type="checkbox" checked={locked} onChange={(event) => desk.set({locked: (event.target as HTMLInputElement).checked})} /> lengths locked</label>
        <label>joint <select aria-label="Joint that the arrow keys move" value={chosen} onChange={(event) => setJoint((event.target as HTMLSelectElement).value)}>
          {movable.map((name) => <option value={name}>{name}</option>)}
        </select></label>
        <output class="dragged" aria-live="polite">{dragging ? dragging.why || dragging.changed.map(({name, before, after}) => `${name} ${short(before)} → ${short(after)}`).join(", ")
          : locked ? "drag a joint: the mechanism follows" : "drag a joint: the lengths change"}</output>
      </div>
    </div>
  );
}
