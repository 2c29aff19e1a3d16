// SPDX-License-Identifier: MIT
// Vertical scales and positions of single traces: set in a list, or by the mark of a trace's zero on the screen.
import {useRef} from "preact/hooks";

import {short} from "../numbers";
import type {Session} from "../session";
import {colourOf, type Theme} from "./drawing";
import {quantity, rangeOf, roomAround, type Screen} from "./screen";
import {divisionsUp, fitted, type OwnScale, placeInWords, scaleSteps} from "./settings";

const small = 0.1, large = 1;  // divisions that a key moves a trace by

/// Gives a trace a scale, or takes the one that it has.
export function setOwn(session: Session, name: string, scale: OwnScale | undefined): void {
  const {scope, drawn} = session.shown, own = new Map(scope.own);
  if (scale) own.set(name, {...scale, position: Number(scale.position.toFixed(2))});
  else own.delete(name);
  session.set({scope: {...scope, own}, drawn: drawn + 1});
}

/// The next scale that there is, larger or smaller.
function nextScale(volts: number, isLarger: boolean): number {
  const near = 1e-9 * volts;
  return (isLarger ? scaleSteps.find((one) => one > volts + near) : scaleSteps.filter((one) => one < volts - near).at(-1)) ?? volts;
}

/// Where the zero of each trace is: dragged up and down, or moved by keys.
export function Grounds({session, screen, names, units}: {session: Session; screen: Screen; names: readonly string[]; units: readonly string[]}) {
  const {frame} = screen.drawing, division = frame.height / divisionsUp;
  const grip = useRef({y: 0, position: 0});  // where it was taken hold of
  return (
    <>
      {screen.own.map(({trace, scale}) => {
        const name = names[trace]!;
        const to = (position: number) => setOwn(session, name, {...scale, position});
        const drag = (event: PointerEvent) => {
          const mark = event.currentTarget as HTMLElement;
          if (event.type === "pointerdown") {
            mark.setPointerCapture(event.pointerId);
            grip.current = {y: event.clientY, position: scale.position};
          } else if (mark.hasPointerCapture(event.pointerId)) {
            to(grip.current.position + (grip.current.y - event.clientY) / division);
          }
        };
        const keys = (event: KeyboardEvent) => {
          const step = event.shiftKey ? large : small;
          const place = ({ArrowUp: scale.position + step, ArrowDown: scale.position - step, PageUp: scale.position + large, PageDown: scale.position - large, Home: 0} as Record<string, number>)[event.key];
          if (place !== undefined) to(place);
          else if (event.key === "+" || event.key === "-") setOwn(session, name, {...scale, volts: nextScale(scale.volts, event.key === "-")});
          else return;
          event.preventDefault();
        };
        const most = Math.max(divisionsUp / 2, Math.abs(scale.position));
        const y = Math.min(Math.max(screen.toY(trace, 0), frame.y), frame.y + frame.height);
        return <div key={name} class="ground" role="slider" tabIndex={0} data-ground={name} aria-label={`Position of ${name} on the screen`} aria-orientation="vertical"
          aria-valuemin={-most} aria-valuemax={most} aria-valuenow={scale.position}
          aria-valuetext={`zero ${placeInWords(scale.position)}, ${quantity(scale.volts, units[trace] ?? "")} a division`}
          style={{left: `${frame.x}px`, top: `${y - 12}px`}} onPointerDown={drag} onPointerMove={drag} onKeyDown={keys} />;
      })}
    </>
  );
}

/// Of each trace its scale and position.
export function OwnScales({session, names, theme}: {session: Session; names: readonly string[]; theme: Theme}) {
  const {scope, traced} = session.shown;
  const fit = (name: string): OwnScale => {
    const trace = traced.indexOf(name);
    return fitted(roomAround(rangeOf(session.oscilloscope.onScreen.sweeps.map((sweep) => sweep.values[trace]!))));
  };
  const choose = (name: string, chosen: string) =>
    setOwn(session, name, chosen === "" ? undefined : chosen === "fit" ? fit(name) : {position: 0, ...scope.own.get(name), volts: Number(chosen)});
  return (
    <details class="own">
      <summary>scale of each trace</summary>
      {names.map((name) => {
        const scale = scope.own.get(name), volts = scale?.volts ?? 0;
        const choices = volts > 0 && !scaleSteps.includes(volts) ? [...scaleSteps, volts].sort((a, b) => a - b) : scaleSteps;
        return (
          <p key={name}>
            <span class="name" style={{borderColor: colourOf(traced.indexOf(name), theme)}}>{name}</span>
            <select aria-label={`Vertical scale of ${name}`} value={String(volts || "")} onChange={(event) => choose(name, (event.target as HTMLSelectElement).value)}>
              <option value="">as the others</option>
              <option value="fit">fit it</option>
              {choices.map((one) => <option value={String(one)}>{short(one)} a division</option>)}
            </select>
            {scale && <label>zero at <input class="level" type="text" inputMode="decimal" aria-label={`Position of ${name}, divisions above the middle`} value={String(scale.position)} onChange={(event) => {
              const field = event.target as HTMLInputElement, position = Number(field.value.replace(",", ".").replace("−", "-"));
              if (field.value.trim() !== "" && Number.isFinite(position)) setOwn(session, name, {...scale, position});
              else field.value = String(scale.position);
            }} /> div</label>}
          </p>
        );
      })}
    </details>
  );
}
