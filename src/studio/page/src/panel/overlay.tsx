// SPDX-License-Identifier: MIT
// What is taken hold of: over the picture of the panel, the bodies and pins of its elements.
import {useRef, useState} from "preact/hooks";

import type {Patching} from "./patching";
import {type At, type Element, gripAt, type Grip, type Sheet} from "./sheet";

interface Drag {
  grip: Grip;
  begin: At;
  at: At;
  moved: boolean;
}

const sameGrip = (a: Grip | undefined, b: Grip) => a !== undefined && JSON.stringify(a) === JSON.stringify(b);

function nameOf(grip: Grip, element: Element, from: string): string {
  if (grip.what === "output") return `output ${grip.signal}${from === grip.signal ? ", picked" : ""}`;
  if (grip.what === "block") return `${element.name}, ${element.type}`;
  const wire = element.wires.find((one) => one.port === grip.port && one.term === grip.term);
  return `input ${element.name}.${grip.port}, ${wire ? `wired: ${wire.text}` : "open"}`;
}

export function Overlay({patching, sheet, width, height, zoom}: {patching: Patching; sheet: Sheet; width: number; height: number; zoom: number}) {
  const {selected, from} = patching.panel;
  const [drag, setDrag] = useState<Drag | undefined>();
  const area = useRef<SVGSVGElement>(null);
  const now = useRef<Drag | undefined>();
  const put = (next: Drag | undefined) => {
    now.current = next;
    setDrag(next);
  };
  const pointOf = (event: MouseEvent): At => {
    const box = area.current!.getBoundingClientRect();
    return [(event.clientX - box.left) / zoom, (event.clientY - box.top) / zoom];
  };

  function pressed(event: PointerEvent): void {
    if (event.button !== 0) return;
    const at = pointOf(event), grip = gripAt(sheet, at);
    if (!grip) return patching.set({selected: undefined, from: ""});
    event.preventDefault();
    area.current!.setPointerCapture(event.pointerId);
    (document.activeElement as HTMLElement | null)?.blur();
    put({grip, begin: at, at, moved: false});
  }
  /// A finger on a grip does not scroll.
  function touched(event: TouchEvent): void {
    const touch = event.touches[0];
    if (event.touches.length !== 1 || !touch) return;
    const box = area.current!.getBoundingClientRect();
    if (gripAt(sheet, [(touch.clientX - box.left) / zoom, (touch.clientY - box.top) / zoom])) event.preventDefault();
  }
  function moved(event: PointerEvent): void {
    const before = now.current;
    if (!before) return;
    const at = pointOf(event);
    put({...before, at, moved: before.moved || Math.hypot(at[0] - before.begin[0], at[1] - before.begin[1]) * zoom > 4});
  }
  function released(event: PointerEvent): void {
    const done = now.current;
    put(undefined);
    if (!done) return;
    if (!done.moved) return act(done.grip);
    const at = pointOf(event), {grip} = done;
    if (grip.what === "block") return void patching.move(grip.block, [at[0] - done.begin[0], at[1] - done.begin[1]]);
    if (grip.what === "output") {
      const to = gripAt(sheet, at, "inputs");
      if (to) void patching.wire(grip.signal, to);
      return;
    }
    if (grip.term !== null) {  // the end of a wire is taken off, and perhaps put somewhere else
      const wire = patching.element(grip.block)?.wires.find((one) => one.port === grip.port && one.term === grip.term);
      const to = gripAt(sheet, at, "inputs");
      if (sameGrip(to, grip)) return;
      const steps = [{do: "disconnect", block: grip.block, port: grip.port, term: grip.term}];
      if (!to || !wire?.signal) return void patching.edit(steps);
      const port = to.what === "input" ? to.port : patching.kind(patching.element(to.block)?.type ?? "")?.inputs[0]?.name;
      if (port !== undefined) void patching.edit([...steps, {do: "connect", signal: wire.signal, block: to.block, port, weight: wire.weight}]);
      return;
    }
    const source = gripAt(sheet, at, "outputs");
    const signal = source?.what === "output" ? source.signal : patching.element(source?.block ?? "")?.outputs[0]?.signal;
    if (signal) void patching.wire(signal, grip);
  }

  /// A click, or the Enter key.
  function act(grip: Grip): void {
    const {from: picked} = patching.panel;
    if (grip.what === "output") return patching.set({from: picked === grip.signal ? "" : grip.signal, selected: {what: "block", block: grip.block}});
    if (picked) return void patching.wire(picked, grip);
    patching.set({selected: grip});
  }
  function twice(event: MouseEvent): void {
    const grip = gripAt(sheet, pointOf(event));
    if (grip?.what === "block" && patching.element(grip.block)?.is_composite) void patching.open(grip.block);
  }

  function keys(event: KeyboardEvent, grip: Grip): void {
    const arrows: Record<string, At> = {ArrowLeft: [-16, 0], ArrowRight: [16, 0], ArrowUp: [0, -16], ArrowDown: [0, 16]};
    const arrow = arrows[event.key];
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.key === "Enter" || event.key === " ") act(grip);
    else if (event.key === "Escape") patching.set({from: "", selected: undefined});
    else if (event.key === "Delete" || event.key === "Backspace") void take(grip);
    else if (arrow && grip.what === "block") void patching.move(grip.block, arrow);
    else return;
    event.preventDefault();
    event.stopPropagation();
  }
  function take(grip: Grip): Promise<boolean> {
    if (grip.what === "block") return patching.remove(grip.block);
    if (grip.what === "input" && grip.term !== null) return patching.cut(grip.block, grip.port, grip.term);
    return Promise.resolve(false);
  }

  const handle = (grip: Grip, element: Element) => ({
    tabindex: 0, role: "button" as const, "aria-label": nameOf(grip, element, from), "aria-pressed": sameGrip(selected, grip) || (grip.what === "output" && grip.signal === from),
    onKeyDown: (event: KeyboardEvent) => keys(event, grip),
  });
  const pulled = drag?.moved && drag.grip.what !== "block" ? drag : undefined;
  const carried = drag?.moved && drag.grip.what === "block" ? patching.element(drag.grip.block)?.body : undefined;
  const target = pulled && gripAt(sheet, pulled.at, pulled.grip.what === "output" || (pulled.grip.what === "input" && pulled.grip.term !== null) ? "inputs" : "outputs");

  return (
    <svg class="overlay" ref={area} width={width} height={height} viewBox={`0 0 ${width / zoom} ${height / zoom}`} role="group" aria-label="Patch panel"
      onPointerDown={pressed} onTouchStart={touched} onPointerMove={moved} onPointerUp={released} onPointerCancel={() => put(undefined)} onDblClick={twice}>
      {sheet.blocks.map((element) => {
        const block: Grip = {what: "block", block: element.name};
        return (
          <g key={element.name} class={sameGrip(target, block) ? "aimed" : undefined}>
            {element.body && <rect class="body" data-block={element.name} x={element.body[0]} y={element.body[1]} width={element.body[2]} height={element.body[3]} {...handle(block, element)} />}
            {element.wires.map((wire) => {
              const grip: Grip = {what: "input", block: element.name, port: wire.port, term: wire.term};
              return wire.at && <rect key={`${wire.port} ${wire.term}`} class={sameGrip(target, grip) ? "pin aimed" : "pin"} data-input={`${element.name}.${wire.port}.${wire.term}`}
                x={wire.at[0] - 13} y={wire.at[1] - 7} width={14} height={14} rx={3} {...handle(grip, element)} />;
            })}
            {element.open.map((open) => {
              const grip: Grip = {what: "input", block: element.name, port: open.port, term: null};
              return <rect key={`${open.port} open`} class={sameGrip(target, grip) ? "pin open aimed" : "pin open"} data-input={`${element.name}.${open.port}`}
                x={open.at[0] - 13} y={open.at[1] - 7} width={14} height={14} rx={3} {...handle(grip, element)} />;
            })}
            {element.outputs.map((output) => {
              const grip: Grip = {what: "output", block: element.name, signal: output.signal};
              return <circle key={output.signal} class={from === output.signal ? "pin picked" : "pin"} data-output={output.signal} cx={output.at[0] + 5} cy={output.at[1]} r={7} {...handle(grip, element)} />;
            })}
          </g>
        );
      })}
      {pulled && <line class="pulled" x1={pulled.begin[0]} y1={pulled.begin[1]} x2={pulled.at[0]} y2={pulled.at[1]} />}
      {carried && drag && <rect class="carried" x={carried[0] + drag.at[0] - drag.begin[0]} y={carried[1] + drag.at[1] - drag.begin[1]} width={carried[2]} height={carried[3]} />}
    </svg>
  );
}
