// SPDX-License-Identifier: MIT
// The schematic alive: its wires have the colour of their voltage, and what is pointed at is read. It works on any picture of the
// library that was drawn with "data": elements with data-signal and data-element.
import {useEffect, useRef, useState} from "preact/hooks";
import type {RefObject} from "preact";

import {short} from "../numbers";
import {useShown, type Session} from "../session";
import {colours, levels, stepOf} from "./colours";

const darkly = matchMedia("(prefers-color-scheme: dark)");

/// A signal of the picture and what is drawn of it.
interface Wire {
  signal: string;
  parts: SVGElement[];
  step: number;  ///< that they are coloured by; −1: none
  over: boolean;
}

const over = (value: number) => Math.abs(value) > 1;

export const signalsOf = (element: Element) => (element.getAttribute("data-signal") ?? "").split(" ").filter(Boolean);

/// "c = 0.5, d = 1.2 (overload) machine unit".
function readings(session: Session, signals: readonly string[]): string {
  const each = signals.map((signal) => {
    const value = session.levels.at(signal);
    return `${signal} = ${short(value)}${over(value) ? " (overload)" : ""}`;
  });
  return `${each.join(", ")} machine unit`;
}

/// The wires of a picture; each gets an area beside it that is easy to hit.
function wiresOf(picture: SVGSVGElement): Wire[] {
  const wires = new Map<string, Wire>();
  const ground = picture.querySelector("rect");
  for (const part of picture.querySelectorAll<SVGElement>("[data-signal]:not([data-element]):not(.hit)")) {
    const signal = part.getAttribute("data-signal")!;
    const wire = wires.get(signal) ?? {signal, parts: [], step: -1, over: false};
    wires.set(signal, wire);
    wire.parts.push(part);
    if (part.tagName !== "path" || part.classList.contains("s-none")) continue;
    const hit = part.cloneNode(true) as SVGElement;
    hit.removeAttribute("id");
    hit.classList.add("hit");
    ground?.after(hit);
  }
  return [...wires.values()];
}

/// Body by body as one reads; the arrow keys go that way.
function inOrder(picture: SVGSVGElement): SVGElement[] {
  const place = new Map<SVGElement, DOMRect>();
  for (const body of picture.querySelectorAll<SVGElement>("[data-element]")) {
    if (signalsOf(body).length > 0) place.set(body, body.getBoundingClientRect());
  }
  // what no body gives: constants that stand at their inputs
  const given = new Set([...place.keys()].flatMap(signalsOf));
  for (const part of picture.querySelectorAll<SVGElement>("circle[data-signal]:not([data-element])")) {
    const signal = part.getAttribute("data-signal")!;
    if (given.has(signal)) continue;
    given.add(signal);
    place.set(part, part.getBoundingClientRect());
  }
  return [...place].sort(([, a], [, b]) => (Math.abs(a.y - b.y) > 8 ? a.y - b.y : a.x - b.x)).map(([body]) => body);
}

/// Colours and reads the picture inside `place`, whoever puts one there.
export function useVoltages(session: Session, place: RefObject<HTMLElement>, coloured: boolean): void {
  useEffect(() => {
    const container = place.current!;
    const stopLooking = session.levels.look();
    let wires: Wire[] = [], bodies: SVGElement[] = [], picture: SVGSVGElement | null = null;
    let byKeys = false;  // what is pointed at is where the keys are

    const colour = () => {
      const of = colours[darkly.matches ? "dark" : "light"];
      for (const wire of wires) {
        const value = session.levels.at(wire.signal), isKnown = coloured && !Number.isNaN(value);
        const step = isKnown ? stepOf(value) : -1, isOver = isKnown && over(value);
        if (step === wire.step && isOver === wire.over) continue;
        wire.step = step;
        wire.over = isOver;
        for (const part of wire.parts) {
          part.style.setProperty(part.classList.contains("s-none") ? "fill" : "stroke", step < 0 ? "" : of[step]!);
          part.classList.toggle("live", step >= 0);
          part.classList.toggle("over", isOver);
        }
      }
    };
    const recolour = () => {
      for (const wire of wires) wire.step = -2;
      colour();
    };
    // What is read aloud of a body, as it stands when the keys come there.
    const name = (body: SVGElement) => body.setAttribute("aria-label", `${body.getAttribute("data-element") ?? "constant"}: ${readings(session, signalsOf(body))}`);
    const take = () => {
      const next = container.querySelector<SVGSVGElement>("svg");
      if (next === picture) return;
      picture = next;
      wires = picture ? wiresOf(picture) : [];
      bodies = picture ? inOrder(picture) : [];
      bodies.forEach((body, k) => {
        body.setAttribute("tabindex", k === 0 ? "0" : "-1");
        body.setAttribute("role", "img");
        name(body);
      });
      session.set({pointed: undefined});
      colour();
    };
    const point = (found: Element | null | undefined) => {
      if (!found || !container.contains(found)) return false;
      const signals = signalsOf(found).filter((signal) => session.levels.has(signal));
      if (signals.length === 0) return false;
      byKeys = false;
      session.set({pointed: {element: found.getAttribute("data-element") ?? "", signals}});
      return true;
    };
    // What lies there, whatever is laid over the picture.
    const under = (event: PointerEvent) => document.elementsFromPoint(event.clientX, event.clientY).find((one) => one.hasAttribute("data-signal"));
    let met: Element | undefined;
    const meets = (event: PointerEvent) => {
      const found = under(event);
      if (event.pointerType !== "mouse" || found === met) return;
      met = found;
      if (!point(found)) session.set({pointed: undefined});
    };
    const pressed = (event: PointerEvent) => {
      if (!point(under(event))) session.set({pointed: undefined});
      else if (event.pointerType === "mouse") void session.meter(session.shown.pointed!.signals[0]!);
    };
    const leaves = (event: PointerEvent) => {
      met = undefined;
      if (event.pointerType === "mouse") session.set({pointed: undefined});
    };
    const focused = (event: FocusEvent) => {
      if (!point((event.target as Element).closest("[data-signal]"))) return;
      byKeys = true;
      for (const body of bodies) body.setAttribute("tabindex", body === event.target ? "0" : "-1");
    };
    const blurred = () => { if (byKeys) session.set({pointed: undefined}); };
    const keys = (event: KeyboardEvent) => {
      const at = bodies.indexOf(event.target as SVGElement);
      if (at < 0) return;
      const to = ({ArrowRight: at + 1, ArrowDown: at + 1, ArrowLeft: at - 1, ArrowUp: at - 1, Home: 0, End: bodies.length - 1} as Record<string, number>)[event.key];
      if (to !== undefined) {
        event.preventDefault();
        const next = bodies[Math.min(Math.max(to, 0), bodies.length - 1)]!;
        name(next);
        next.focus();
      } else if (event.key === "Enter") {
        const [first] = signalsOf(bodies[at]!);
        if (first) void session.meter(first);
      }
    };

    take();
    const watch = new MutationObserver(take);
    watch.observe(container, {childList: true, subtree: true});
    const unsubscribe = session.subscribe(colour);
    darkly.addEventListener("change", recolour);
    container.addEventListener("pointermove", meets);
    container.addEventListener("pointerdown", pressed);
    container.addEventListener("pointerleave", leaves);
    container.addEventListener("focusin", focused);
    container.addEventListener("focusout", blurred);
    container.addEventListener("keydown", keys);
    return () => {
      stopLooking();
      unsubscribe();
      watch.disconnect();
      darkly.removeEventListener("change", recolour);
      container.removeEventListener("pointermove", meets);
      container.removeEventListener("pointerdown", pressed);
      container.removeEventListener("pointerleave", leaves);
      container.removeEventListener("focusin", focused);
      container.removeEventListener("focusout", blurred);
      container.removeEventListener("keydown", keys);
      for (const wire of wires) {
        for (const part of wire.parts) {
          part.style.removeProperty("stroke");
          part.style.removeProperty("fill");
          part.classList.remove("live", "over");
        }
      }
      container.querySelectorAll(".hit").forEach((hit) => hit.remove());
    };
  }, [session, coloured]);
}

/// "c = 0.5 machine unit": what is pointed at.
export function Pointed({session}: {session: Session}) {
  const pointed = useShown(session, (shown) => shown.pointed);
  useShown(session, (shown) => (shown.pointed ? shown.levels : 0));
  if (!pointed) return null;
  return <>{readings(session, pointed.signals)}</>;
}

/// What the colours mean, and the reading of what is pointed at.
export function Legend({session, coloured, setColoured}: {session: Session; coloured: boolean; setColoured: (on: boolean) => void}) {
  const [dark, setDark] = useState(darkly.matches);
  useEffect(() => {
    const turn = () => setDark(darkly.matches);
    darkly.addEventListener("change", turn);
    return () => darkly.removeEventListener("change", turn);
  }, []);
  const of = colours[dark ? "dark" : "light"], parts = 16;
  return (
    <div class="voltages">
      <label><input type="checkbox" checked={coloured} onChange={(event) => setColoured((event.target as HTMLInputElement).checked)} /> voltages</label>
      {coloured && (
        <svg class="scale" width="300" height="30" viewBox="0 0 300 30" role="img" aria-label="Colours of the wires: blue at −1, grey at 0, orange at 1 machine unit; thick and dashed beyond, an overload">
          {Array.from({length: parts + 1}, (_, k) => <rect x={14 + k * 8} y="3" width="8.5" height="8" fill={of[Math.round(k * 2 * levels / parts)]} />)}
          <text x="18" y="25" text-anchor="middle">−1</text><text x="82" y="25" text-anchor="middle">0</text><text x="146" y="25" text-anchor="middle">+1</text>
          <path class="over" d="M172 7 H206" fill="none" stroke={of[2 * levels]} /><text x="189" y="25" text-anchor="middle">overload</text>
          <text x="226" y="12">machine unit</text>
        </svg>
      )}
      <output class="pointed" aria-live="off" aria-label="Reading of what is pointed at"><Pointed session={session} /></output>
    </div>
  );
}

/// What colours a picture in `place`, with the legend above it.
export function Voltages({session, place}: {session: Session; place: RefObject<HTMLElement>}) {
  const [coloured, setColoured] = useState(true);
  useVoltages(session, place, coloured);
  return <Legend session={session} coloured={coloured} setColoured={setColoured} />;
}
