// SPDX-License-Identifier: MIT
import {useEffect, useState} from "preact/hooks";

import {short} from "../numbers";
import {useShown} from "../session";
import type {Modes} from "./answers";
import type {Desk} from "./desk";

/// All ways to put each group together, as pictures; one is taken into the file's sketch.
export function AssemblyModes({desk}: {desk: Desk}) {
  const {session} = desk;
  const written = useShown(session, (shown) => shown.written);
  const name = useShown(session, (shown) => shown.file.name);
  const held = useShown(session, (shown) => shown.held);
  const [isOpen, setOpen] = useState(false);
  const [modes, setModes] = useState<Modes | undefined>();
  useEffect(() => {
    if (!isOpen) return;
    let left = false;
    const later = setTimeout(() => void desk.study.ask<Modes>("modes", written, name).then((found) => { if (!left) setModes(found); }, () => undefined), 200);
    return () => {
      left = true;
      clearTimeout(later);
    };
  }, [isOpen, written, held]);
  return (
    <details class="modes-panel" onToggle={(event) => setOpen((event.target as HTMLDetailsElement).open)}>
      <summary>Assembly modes</summary>
      {isOpen && !modes && <p class="quiet">looked for …</p>}
      {modes && !modes.ok && <p class="quiet">{modes.diagnostics?.[0]?.what}</p>}
      {modes?.ok && modes.groups.length === 0 && <p class="quiet">every group can be put together in one way only</p>}
      {modes?.ok && modes.groups.map((group) => (
        <section aria-label={`Assembly modes of ${group.name}`}>
          <h3>{group.name} <span class="quiet">class {group.class}, {group.complete ? "" : "at least "}{group.modes.length} modes at the start</span></h3>
          <div class="mode-list">
            {group.modes.map((mode) => {
              const where = Object.entries(mode.points).map(([point, at]) => `${point} (${short(Number(at[0].toPrecision(4)))}, ${short(Number(at[1].toPrecision(4)))})`).join(", ");
              return (
                <button class="mode" aria-pressed={mode.selected} disabled={!mode.text} title={mode.why ?? where} aria-label={`${mode.selected ? "the chosen mode" : "take the mode"} with ${where}`}
                  onClick={() => void session.load({name, text: mode.text!})}>
                  {mode.svg ? <span aria-hidden="true" dangerouslySetInnerHTML={{__html: mode.svg}} /> : <span class="quiet">{mode.why ?? "not assembled"}</span>}
                  <span>{mode.selected ? "✓ chosen" : mode.text ? "take" : "not to be had"}</span>
                </button>
              );
            })}
          </div>
        </section>
      ))}
    </details>
  );
}
