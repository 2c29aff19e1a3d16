// SPDX-License-Identifier: MIT
import {useState} from "preact/hooks";

import type {Patching} from "./patching";
import type {At, Kind} from "./sheet";
import {usePanel} from "./use_panel";

const usual = ["constant", "potentiometer", "summer", "integrator", "inverter", "multiplier", "servo-amplifier", "divider"];

function found(kinds: Kind[], asked: string): Kind[] {
  const words = asked.toLowerCase().split(/\s+/).filter((word) => word !== "");
  const rank = (kind: Kind) => {
    const place = usual.indexOf(kind.name);
    const isNamed = words.length > 0 && `${kind.name} ${kind.title}`.toLowerCase().includes(words.join(" "));
    return (isNamed ? -100 : 0) + (place < 0 ? usual.length : place);
  };
  return kinds.filter((kind) => words.every((word) => `${kind.name} ${kind.title} ${kind.summary}`.toLowerCase().includes(word)))
    .map((kind, place) => ({kind, place})).sort((a, b) => rank(a.kind) - rank(b.kind) || a.place - b.place).map(({kind}) => kind);
}

/// The elements that there are: a click, Enter or a drag adds one.
export function Palette({patching, free, drop}: {patching: Patching; free: () => At; drop: (event: PointerEvent) => At | undefined}) {
  const {kinds} = usePanel(patching);
  const [asked, setAsked] = useState("");
  const [pulled, setPulled] = useState("");

  function pressed(event: PointerEvent, kind: Kind): void {
    if (event.pointerType !== "mouse" || event.button !== 0) return;  // fingers scroll the list, and tap
    const begin: At = [event.clientX, event.clientY];
    let isPulled = false;
    const moved = (now: PointerEvent) => {
      if (!isPulled && Math.hypot(now.clientX - begin[0], now.clientY - begin[1]) > 6) {
        isPulled = true;
        setPulled(kind.name);
      }
    };
    const released = (now: PointerEvent) => {
      removeEventListener("pointermove", moved);
      removeEventListener("pointerup", released);
      if (!isPulled) return;
      setPulled("");
      const at = drop(now);
      if (at) void patching.add(kind.name, at);
    };
    addEventListener("pointermove", moved);
    addEventListener("pointerup", released);
  }

  return (
    <div class={pulled ? "palette pulling" : "palette"}>
      <input type="search" placeholder={`find one of ${kinds.length} elements`} aria-label="Find an element" value={asked}
        onInput={(event) => setAsked((event.target as HTMLInputElement).value)}
        onKeyDown={(event) => {
          const first = found(kinds, asked)[0];
          if (event.key === "Enter" && first) void patching.add(first.name, free());
        }} />
      <ul aria-label="Elements">
        {found(kinds, asked).map((kind) => (
          <li key={kind.name}>
            <button data-kind={kind.name} title={kind.summary} onPointerDown={(event) => pressed(event, kind)} onClick={() => pulled || void patching.add(kind.name, free())}>
              <span class="symbol" dangerouslySetInnerHTML={{__html: kind.svg}} />
              <span><b>{kind.title}</b> <span class="quiet">{kind.name}</span><br /><span class="summary">{kind.summary}</span></span>
            </button>
          </li>
        ))}
      </ul>
    </div>
  );
}
