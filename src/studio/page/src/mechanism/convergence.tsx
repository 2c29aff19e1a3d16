// SPDX-License-Identifier: MIT
import {useEffect, useMemo, useRef, useState} from "preact/hooks";

import {Stopped} from "../machine";
import {rough} from "../numbers";
import {useShown} from "../session";
import type {Answer} from "../answers";
import type {Compared} from "./answers";
import type {Desk} from "./desk";
import {Newest, Study} from "./store";

const decades = [1e2, 1e3, 1e4, 1e5, 1e6, 1e7];
const digits = (value: number | null) => (value === null ? "–" : value.toExponential(2));

/// The error over the gain, gain after gain, with its parts.
export function Convergence({desk}: {desk: Desk}) {
  const {session} = desk;
  const file = useShown(session, (shown) => shown.file);
  const split = useShown(session, (shown) => shown.split);
  const [isOpen, setOpen] = useState(false);
  const [exponent, setExponent] = useState(4);
  const [compared, setCompared] = useState<Compared | undefined>();
  const [running, setRunning] = useState("");
  const [why, setWhy] = useState("");
  const study = useMemo(() => new Study(), []);
  const asks = useMemo(() => new Newest(), []);
  const of = useRef("");  // what the worker compares
  const ends = useRef(false);

  async function add(gain: number): Promise<void> {
    const wanted = `${split.join()}\n${file.text}`;
    setRunning(`gain ${rough(gain)} …`);
    try {
      if (of.current !== wanted) {
        const opened = await study.ask<Answer>("comparison.open", file.text, {split}, file.name);
        if (!opened.ok) return setWhy(opened.diagnostics?.[0]?.message ?? "");
        of.current = wanted;
      }
      const added = await study.ask<Compared>("comparison.add", gain);
      setWhy(added.ok ? "" : added.diagnostics?.[0]?.message ?? "");
      if (added.ok) setCompared(added);
    } finally {
      setRunning("");
    }
  }
  async function sweep(): Promise<void> {
    ends.current = false;
    for (const gain of decades) {
      if (!ends.current) await add(gain);
    }
  }
  async function stop(): Promise<void> {
    ends.current = true;
    of.current = "";
    await study.stop();
  }
  useEffect(() => {
    setCompared(undefined);
    setWhy("");
  }, [file.text, split]);

  const quietly = (work: Promise<void>) => work.catch((error) => { if (!(error instanceof Stopped)) throw error; });
  const last = compared?.runs.reduce((best, run) => (Math.abs(Math.log10(run.gain) - exponent) < Math.abs(Math.log10(best.gain) - exponent) ? run : best));
  return (
    <details class="convergence" onToggle={(event) => setOpen((event.target as HTMLDetailsElement).open)}>
      <summary>Convergence</summary>
      {isOpen && <>
        <div class="linkage-line">
          <label>gain <input type="range" aria-label="Gain of the comparison, a power of ten" min={1} max={8} step={0.25} value={exponent} onInput={(event) => {
            const asked = Number((event.target as HTMLInputElement).value);
            setExponent(asked);
            asks.ask(() => add(10 ** asked));
          }} /> <output>{rough(10 ** exponent)}</output></label>
          <button disabled={running !== ""} onClick={() => void quietly(sweep())}>Sweep decades</button>
          <button class="stop" disabled={running === ""} onClick={() => void stop()}>Stop</button>
          <output class="quiet" aria-live="polite">{running}</output>
        </div>
        {why && <p class="findings">{why}</p>}
        {compared ? <div class="chart" role="img" aria-label={`Error over the gain, ${compared.runs.length} points`} dangerouslySetInnerHTML={{__html: compared.svg}} />
          : !why && <p class="quiet">Each gain patches the mechanism anew, runs it over its motion and holds it against the exact one.</p>}
        {compared && <p class="verdict" role="status">{compared.order === null ? "an order takes two gains whose errors stand clear of the tolerance" : `the error falls with the gain to the power ${compared.order.toFixed(3).replace("-", "−")}`}</p>}
        {last && <table class="parts">
          <caption>the largest error at gain {rough(last.gain)} [{desk.now.mechanism?.unit}], at {last.worst}{last.off_branch ? ", on another branch" : ""}</caption>
          <thead><tr><th>error</th><th>static</th><th>lag</th><th>solver</th></tr></thead>
          <tbody><tr><td>{digits(last.max_error)}</td><td>{digits(last.static)}</td><td>{digits(last.lag)}</td><td>{digits(last.solver)}</td></tr></tbody>
        </table>}
      </>}
    </details>
  );
}
