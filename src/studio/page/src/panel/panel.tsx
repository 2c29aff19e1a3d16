// SPDX-License-Identifier: MIT
// The patch panel: the schematic under one's hands, what can be added to it, and what can be set of it.
import {useEffect, useRef, useState} from "preact/hooks";

import {useShown, type Session} from "../session";
import {Form} from "./form";
import {Overlay} from "./overlay";
import {Palette} from "./palette";
import type {Patching} from "./patching";
import {type At, sizeOf} from "./sheet";
import {usePanel} from "./use_panel";
import {Voltages} from "../voltages/voltages";

const mostHandled = 400;  // elements; larger diagrams are edited in the text

/// Ctrl+Z and Ctrl+Y, wherever nothing is being written but the file.
function keysOf(patching: Patching, event: KeyboardEvent): void {
  const key = event.key.toLowerCase();
  if (!(event.ctrlKey || event.metaKey) || event.altKey || (key !== "z" && key !== "y")) return;
  const field = event.target as HTMLInputElement;
  if (field.matches("input[type=text], input[type=search]") && field.value !== (field.dataset.said ?? "")) return;
  event.preventDefault();
  void (key === "y" || event.shiftKey ? patching.redo() : patching.undo());
}

/// How large the picture is.
function Zoom({zoom, least, set}: {zoom: number; least: number; set: (zoom: number) => void}) {
  return (
    <>
      <button aria-label="Smaller" disabled={zoom <= least} onClick={() => set(Math.max(least, zoom / 1.25))}>−</button>
      <button aria-label="Larger" disabled={zoom >= 3} onClick={() => set(Math.min(3, zoom * 1.25))}>+</button>
    </>
  );
}

/// A picture that is shown as wide as its place, or zoomed.
const zoomed = (classes: string, zoom: number) => ({class: zoom > 1 ? `${classes} zoomed` : classes, style: {"--zoom": zoom}});

function Bench({session, patching}: {session: Session; patching: Patching}) {
  const {sheet, isOld, from, refusal} = usePanel(patching);
  const machine = useShown(session, (shown) => (shown.held ? shown.file.name : ""));
  const place = useRef<HTMLDivElement>(null);
  const [zoom, setZoom] = useState(1);
  const [room, setRoom] = useState<At>([600, 360]);
  const [adds, setAdds] = useState(false);
  useEffect(() => {
    const watch = new ResizeObserver(() => setRoom([place.current!.clientWidth, place.current!.clientHeight]));
    watch.observe(place.current!);
    return () => watch.disconnect();
  }, []);
  useEffect(() => {
    if (sheet?.blocks.length === 0) setAdds(true);
  }, [sheet?.blocks.length === 0]);

  const {name} = session.source;
  const hasSheet = sheet !== undefined;
  useEffect(() => {  // a file that is opened is seen whole, if that can still be read
    if (sheet) setZoom(Math.min(1, Math.max(0.6, place.current!.clientWidth / sizeOf(sheet.svg)[0])));
  }, [name, hasSheet]);

  const [wide, high] = sheet ? sizeOf(sheet.svg) : [0, 0];
  const width = Math.max(wide * zoom, room[0]), height = Math.max(high * zoom, room[1]);
  const isHandled = sheet !== undefined && sheet.blocks.length <= mostHandled;
  const free = (): At => {
    const at = place.current!, taken = sheet?.blocks.some((block) => block.body) ?? false;
    return [(at.scrollLeft + (taken ? at.clientWidth / 2 : 90)) / zoom, (at.scrollTop + (taken ? at.clientHeight / 2 : 70)) / zoom];
  };
  const drop = (event: PointerEvent): At | undefined => {
    const at = place.current!, box = at.getBoundingClientRect();
    if (event.clientX < box.left || event.clientX > box.right || event.clientY < box.top || event.clientY > box.bottom) return undefined;
    return [(event.clientX - box.left + at.scrollLeft) / zoom, (event.clientY - box.top + at.scrollTop) / zoom];
  };
  const atInputs = sheet?.blocks.filter((block) => !block.body) ?? [];

  return (
    <>
      <div class="tools" role="toolbar" aria-label="Patch panel">
        <button disabled={!patching.panel.canUndo} title="Ctrl+Z" onClick={() => void patching.undo()}>Undo</button>
        <button disabled={!patching.panel.canRedo} title="Ctrl+Y" onClick={() => void patching.redo()}>Redo</button>
        <button aria-pressed={adds} onClick={() => setAdds(!adds)}>Add an element</button>
        <Zoom zoom={zoom} least={0.25} set={setZoom} />
        {from && <span role="status">from {from}: pick an input</span>}
      </div>
      <Voltages session={session} place={place} />
      {adds && <Palette patching={patching} free={free} drop={drop} />}
      <div class={isOld ? "picture schematic panel old" : "picture schematic panel"} ref={place} data-at={sheet?.origin.join(" ")}>
        <div class="sheet" style={{width: `${width}px`, height: `${height}px`}}>
          {sheet && <div style={{width: `${wide * zoom}px`, height: `${high * zoom}px`}} dangerouslySetInnerHTML={{__html: sheet.svg}} />}
          {sheet?.blocks.length === 0 && <p class="quiet invitation">Click an element above, or drag it here.</p>}
          {isHandled && !isOld && <Overlay patching={patching} sheet={sheet} width={width} height={height} zoom={zoom} />}
        </div>
      </div>
      {machine !== "" && machine !== name && <p class="remark">The console still holds the machine of {machine}: this file is not right yet.</p>}
      {isOld && <p class="remark">The panel shows the text as it last could be read.</p>}
      {sheet && !isHandled && <p class="remark">{sheet.blocks.length} elements: so many are edited in the text.</p>}
      {sheet && sheet.lost.length > 0 && <p class="remark">The dashed wires of {sheet.lost.join(", ")} find no way: move what is around them.</p>}
      {refusal.length > 0 && <ul class="findings" role="alert">{refusal.map((finding) => <li>{finding.what}{finding.expected && `; expected ${finding.expected}`}{finding.remedy && <div class="remedy">{finding.remedy}</div>}</li>)}</ul>}
      {atInputs.length > 0 && <p class="tools">at inputs: {atInputs.map((block) => (
        <button key={block.name} data-constant={block.name} onClick={() => patching.set(from === "" ? {selected: {what: "block", block: block.name}} : {from: block.name})}>{block.name}</button>
      ))}</p>}
      {isHandled && <Form session={session} patching={patching} />}
    </>
  );
}

/// The patch of a mechanism, to be seen only.
function Shown({session, schematic, zoom}: {session: Session; schematic: string; zoom: number}) {
  const place = useRef<HTMLDivElement>(null);
  return (
    <>
      <Voltages session={session} place={place} />
      <div {...zoomed("picture schematic", zoom)} ref={place} role="group" aria-label="Schematic: the arrow keys go from element to element, the voltmeter reads it" dangerouslySetInnerHTML={{__html: schematic}} />
    </>
  );
}

/// The inside of a composite, with a way back.
function Inside({session, patching, path, svg}: {session: Session; patching: Patching; path: string; svg: string}) {
  const place = useRef<HTMLDivElement>(null);
  const [zoom, setZoom] = useState(1);
  const parts = path.split(".");
  const enter = (event: Event) => {
    const id = (event.target as SVGElement).closest("[id^='block-']")?.id.slice("block-".length);
    if (id) void patching.open(`${path}.${id}`);
  };
  return (
    <>
      <div class="tools" role="toolbar" aria-label="Composite">
        <button onClick={() => void patching.open("")}>Back to the diagram</button>
        {parts.map((part, k) => <button class="link" onClick={() => void patching.open(parts.slice(0, k + 1).join("."))}>{part}</button>)}
        <Zoom zoom={zoom} least={1} set={setZoom} />
        <span class="quiet">as the block's file has it, to be seen only</span>
      </div>
      <Voltages session={session} place={place} />
      <div {...zoomed("picture schematic inside", zoom)} ref={place} dangerouslySetInnerHTML={{__html: svg}} onDblClick={enter} />
    </>
  );
}

export function PatchPanel({session, patching}: {session: Session; patching: Patching}) {
  const {sheet, inside, isOld} = usePanel(patching);
  const schematic = useShown(session, (shown) => shown.schematic);
  const kind = useShown(session, (shown) => shown.kind);
  const [zoom, setZoom] = useState(1);
  useEffect(() => {
    const keys = (event: KeyboardEvent) => keysOf(patching, event);
    addEventListener("keydown", keys);
    return () => removeEventListener("keydown", keys);
  }, [patching]);
  if (inside) return <Inside session={session} patching={patching} {...inside} />;
  if (sheet || (isOld && !schematic)) return <Bench session={session} patching={patching} />;
  return (
    <>
      <div class="tools">
        <button disabled={!patching.panel.canUndo} title="Ctrl+Z" onClick={() => void patching.undo()}>Undo</button>
        <button disabled={!patching.panel.canRedo} title="Ctrl+Y" onClick={() => void patching.redo()}>Redo</button>
        {kind === "mechanism" && <button title="the patch becomes a diagram of its own" onClick={() => void patching.editPatch()}>Edit the patch</button>}
        <Zoom zoom={zoom} least={1} set={setZoom} />
      </div>
      <Shown session={session} schematic={schematic} zoom={zoom} />
    </>
  );
}
