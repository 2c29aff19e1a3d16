// SPDX-License-Identifier: MIT
import {useEffect, useMemo, useState} from "preact/hooks";

import {rough} from "../numbers";
import {useShown} from "../session";
import type {Loops, Splits} from "./answers";
import type {Desk} from "./desk";
import {Plane} from "./plane";
import {Newest, useStore} from "./store";

/// How much slower than its triangles the outer loop of the machine is, by the pot that says so.
function slowerOf(loops: Loops | undefined, pots: {name: string; value: number}[]): number | undefined {
  const pot = pots.find(({name}) => name === `${loops?.outer[0]}.bandwidth`);
  return loops && pot ? loops.bandwidth / pot.value : undefined;
}

/// The split of a triad, the speed of its outer loop, and the eigenvalues that come of it.
export function LoopsPanel({desk}: {desk: Desk}) {
  const {session, study} = desk;
  const {position} = useStore(desk);
  const file = useShown(session, (shown) => shown.file);
  const held = useShown(session, (shown) => shown.held);
  const gain = useShown(session, (shown) => shown.gain);
  const split = useShown(session, (shown) => shown.split);
  const pots = useShown(session, (shown) => shown.pots);
  const [isOpen, setOpen] = useState(false);
  const [splits, setSplits] = useState<Splits["splits"]>([]);
  const [loops, setLoops] = useState<Loops | undefined>();
  const [why, setWhy] = useState("");
  const asks = useMemo(() => new Newest(), []);
  const slower = slowerOf(loops, pots);

  const look = (asked: number | undefined) => asks.ask(async () => {
    const options = {gain, split, moments: 31, ...(asked === undefined ? {} : {slower: asked})};
    const found = await study.ask<Loops>("loops", file.text, options, file.name);
    setWhy(found.ok ? found.no_rest ?? "" : found.diagnostics?.[0]?.what ?? "");
    if (found.ok) setLoops(found);
  });
  useEffect(() => {
    if (!isOpen) return;
    setLoops(undefined);
    void study.ask<Splits>("splits", file.text, file.name).then((found) => setSplits(found.ok ? found.splits : []), () => undefined);
    look(undefined);
  }, [isOpen, held]);

  /// The machine goes on with another bandwidth of its outer amplifiers.
  const turn = (asked: number) => {
    if (!loops || !(asked > 0)) return;
    for (const name of loops.outer) void session.turn(`${name}.bandwidth`, loops.bandwidth / asked);
    look(asked);
  };
  const choose = async (legs: string[]) => {
    if (!(await session.open(file, {split: legs}))) await session.open(file, {split: legs, force: true});
  };
  const legs = (split.length > 0 ? split : loops?.split ?? []).join(", ");
  const rightmost = loops?.rightmost;

  return (
    <details class="loops-panel" onToggle={(event) => setOpen((event.target as HTMLDetailsElement).open)}>
      <summary>Loops and their eigenvalues</summary>
      {isOpen && splits.length > 0 && (
        <div class="linkage-line">
          <label>split <select aria-label="Split of the triad" value={legs} onChange={(event) => void choose((event.target as HTMLSelectElement).value.split(", "))}>
            {splits.map((one) => <option value={one.legs.join(", ")}>{one.legs.join(", ")}{one.flips === null ? ` (worth ${rough(one.worth)})` : ` (flips at ${rough(one.flips)} s)`}</option>)}
          </select></label>
          {slower !== undefined && <>
            <label>slower <input type="range" aria-label="How many times slower the outer loop is, a power of ten" min={-2} max={3} step={0.05} value={Math.log10(slower)}
              onInput={(event) => turn(10 ** Number((event.target as HTMLInputElement).value))} /></label>
            <label>× <input class="slower" type="text" inputMode="decimal" aria-label="How many times slower the outer loop is" value={rough(slower)}
              onChange={(event) => turn(Number((event.target as HTMLInputElement).value))} /></label>
          </>}
        </div>
      )}
      {isOpen && splits.length === 0 && <p class="quiet">no triad on three links, so nothing to split and no outer loop</p>}
      {why && <p class="quiet">{why}</p>}
      {loops && <Plane loops={loops} time={position?.time ?? 0} />}
      {loops && <p class="verdict" role="status">{loops.growing > 0 ? `▲ unstable: ${loops.growing} eigenvalues of ${loops.rows} grow` : "○ every loop comes back to rest"}
        {rightmost && `; rightmost ${rough(rightmost.real)}${rightmost.imaginary > 0 ? ` ± ${rough(rightmost.imaginary)}i` : ""} 1/s (${rightmost.signal}, t = ${rough(rightmost.time)} s)`}</p>}
    </details>
  );
}
