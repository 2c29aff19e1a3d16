// SPDX-License-Identifier: MIT
import {useEffect, useRef} from "preact/hooks";
import uPlot from "uplot";

import {short} from "./numbers";
import {useShown, type Session} from "./session";
import {save} from "./share";
import type {Traces} from "./traces";

const colours = ["#4393c3", "#d6604d", "#5aae61", "#9970ab", "#c9a227", "#35978f", "#de77ae", "#8c8c8c"];

function colourOf(trace: number): string {
  return colours[trace % colours.length]!;
}

function styleOf(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

function rangeOf(columns: Float64Array[]): [number, number] {
  let low = Infinity, high = -Infinity;
  for (const column of columns) {
    for (const value of column) {
      if (value < low) low = value;
      if (value > high) high = value;
    }
  }
  if (!(low <= high)) return [-1, 1];
  const more = high > low ? 0.06 * (high - low) : 0.1 * Math.max(1, Math.abs(high));
  return [low - more, high + more];
}

interface Shown {
  traces: Traces;
  drawn: number;  ///< counts up where there is something new to be seen
  height: number;
}

/// Signals over the time.
function OverTime({traces, drawn, height}: Shown) {
  const place = useRef<HTMLDivElement>(null);
  const plot = useRef<uPlot>();
  const names = traces.names.join("\n");
  const data = () => [traces.column(0), ...traces.names.map((_, k) => traces.column(1 + k))] as unknown as uPlot.AlignedData;

  useEffect(() => {
    const axis = {stroke: () => styleOf("--ink"), grid: {stroke: () => styleOf("--faint"), width: 1}, ticks: {stroke: () => styleOf("--faint"), width: 1}};
    const made = new uPlot({
      width: place.current!.clientWidth,
      height,
      legend: {live: true},
      cursor: {drag: {x: true, y: false}},
      scales: {x: {time: false}, y: {range: (_, low, high) => rangeOf([Float64Array.of(low ?? NaN, high ?? NaN)])}},
      axes: [{...axis, label: "t [s]", labelSize: 18}, {...axis, size: 64}],
      series: [{label: "t"}, ...traces.names.map((label, k) => ({label, stroke: colourOf(k), width: 1.5, points: {show: false}}))],
    }, data(), place.current!);
    plot.current = made;
    const watch = new ResizeObserver(() => made.setSize({width: place.current!.clientWidth, height}));
    watch.observe(place.current!);
    return () => {
      watch.disconnect();
      made.destroy();
    };
  }, [names, height]);

  useEffect(() => plot.current?.setData(data()), [drawn, names]);
  return <div class="screen" ref={place} role="img" aria-label={`Oscilloscope: ${traces.names.join(", ")} over the time`} />;
}

/// Signals over another one: the beam's way.
function OverSignal({traces, against, drawn, height}: Shown & {against: string}) {
  const canvas = useRef<HTMLCanvasElement>(null);
  useEffect(() => {
    const at = canvas.current!, width = at.clientWidth, scale = devicePixelRatio, margin = 28;
    at.width = width * scale;
    at.height = height * scale;
    const pen = at.getContext("2d")!;
    pen.scale(scale, scale);
    const place = traces.names.indexOf(against), x = traces.column(1 + place);
    const others = traces.names.map((_, k) => k).filter((k) => k !== place);
    const ys = others.map((k) => traces.column(1 + k));
    const [left, right] = rangeOf([x]), [low, high] = rangeOf(ys);
    const px = (value: number) => margin + (value - left) / (right - left) * (width - 2 * margin);
    const py = (value: number) => height - margin - (value - low) / (high - low) * (height - 2 * margin);
    pen.strokeStyle = styleOf("--faint");
    pen.fillStyle = styleOf("--ink");
    pen.font = "12px sans-serif";
    pen.strokeRect(margin, margin, width - 2 * margin, height - 2 * margin);
    pen.fillText(short(left), margin, height - 8);
    pen.textAlign = "right";
    pen.fillText(short(right), width - margin, height - 8);
    pen.textAlign = "center";
    pen.fillText(against, width / 2, height - 8);
    pen.textAlign = "left";
    pen.fillText(`${short(low)} … ${short(high)}`, margin, 16);
    ys.forEach((y, series) => {
      pen.strokeStyle = colourOf(others[series]!);
      pen.lineWidth = 1.5;
      pen.beginPath();
      let dark = true;
      for (let k = 0; k < x.length; ++k) {
        if (Number.isNaN(x[k]!) || Number.isNaN(y[k]!)) {
          dark = true;
        } else if (dark) {
          pen.moveTo(px(x[k]!), py(y[k]!));
          dark = false;
        } else {
          pen.lineTo(px(x[k]!), py(y[k]!));
        }
      }
      pen.stroke();
    });
  }, [traces, against, drawn, height]);
  return <canvas class="screen" ref={canvas} style={{height: `${height}px`}} role="img"
    aria-label={`Oscilloscope: ${traces.names.filter((name) => name !== against).join(", ")} over ${against}`} />;
}

/// The screen, over the time or over a signal, and what is shown on it.
export function Scope({session}: {session: Session}) {
  const traced = useShown(session, (shown) => shown.traced);
  const against = useShown(session, (shown) => shown.against);
  const persists = useShown(session, (shown) => shown.persists);
  const drawn = useShown(session, (shown) => shown.drawn);
  useShown(session, (shown) => shown.held);
  const {channels, traces} = session;
  const screen = {traces, drawn, height: 280};
  return (
    <>
      {traced.includes(against) && traced.length > 1 ? <OverSignal against={against} {...screen} /> : <OverTime {...screen} />}
      <div class="channels">
        <label>over <select aria-label="What the traces are drawn against" value={against} onChange={(event) => {
          const name = (event.target as HTMLSelectElement).value;
          if (name && !traced.includes(name)) session.trace([...traced, name], name);
          else session.set({against: name});
        }}>
          <option value="">t</option>
          {channels.map((name) => <option value={name}>{name}</option>)}
        </select></label>
        <label>trace <select aria-label="Add a trace" value="" onChange={(event) => session.trace([...traced, (event.target as HTMLSelectElement).value])}>
          <option value="">add …</option>
          {channels.filter((name) => !traced.includes(name)).map((name) => <option value={name}>{name}</option>)}
        </select></label>
        {traced.map((name, k) => <button class="trace" style={{borderColor: colourOf(k)}} aria-label={`Take ${name} off the scope`}
          onClick={() => session.trace(traced.filter((one) => one !== name))}>{name} ×</button>)}
        <label><input type="checkbox" checked={persists} onChange={(event) => session.set({persists: (event.target as HTMLInputElement).checked})} /> persistence</label>
        <button onClick={() => save("traces.csv", session.traces.csv(), "text/csv")}>CSV</button>
      </div>
    </>
  );
}
