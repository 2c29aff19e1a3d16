// SPDX-License-Identifier: MIT
import {useState} from "preact/hooks";

import {besideNumber} from "../numbers";
import type {Session} from "../session";
import type {Patching} from "./patching";
import type {Element, Kind, Wire} from "./sheet";

/// A line to be written in: taken when it is left, or by Enter. `said` is what the file says.
function Line({label, said, hint = "", unit = "", title = "", clears = false, take}:
    {label: string; said: string; hint?: string; unit?: string; title?: string; clears?: boolean; take: (value: string) => void}) {
  return (
    <label class="line" title={title}><span>{label}</span>
      <input type="text" key={said} data-said={said} defaultValue={said} placeholder={hint} aria-label={label}
        onChange={(event) => {
          const written = (event.target as HTMLInputElement).value.trim();
          if (written === said) return;
          take(written);
          if (clears) (event.target as HTMLInputElement).value = "";
        }} />
      <span class="unit">{besideNumber(unit)}</span>
    </label>
  );
}

function WireRow({patching, element, wire, isChosen}: {patching: Patching; element: Element; wire: Wire; isChosen: boolean}) {
  const at = {block: element.name, port: wire.port, term: wire.term};
  return (
    <li class={isChosen ? "chosen" : undefined}>
      <button aria-label={`Sign of ${wire.text}`} disabled={!wire.signal} onClick={() => void patching.edit([{do: "weigh", ...at, weight: -wire.weight}])}>{wire.weight < 0 ? "−" : "+"}</button>
      <input type="text" inputMode="decimal" aria-label={`Weight of ${wire.text}`} key={String(wire.weight)} data-said={String(Math.abs(wire.weight))} defaultValue={String(Math.abs(wire.weight))} disabled={!wire.signal}
        onChange={(event) => {
          const weight = Number((event.target as HTMLInputElement).value.replace(",", "."));
          if (!Number.isFinite(weight)) return patching.refuse(`'${(event.target as HTMLInputElement).value}' is no weight: a number, such as 0.5`);
          void patching.edit([{do: "weigh", ...at, weight: wire.weight < 0 ? -weight : weight}]);
        }} />
      <span>{wire.signal || wire.text}</span>
      <button aria-label={`Take off ${wire.text}`} onClick={() => void patching.cut(element.name, wire.port, wire.term)}>×</button>
    </li>
  );
}

function Inputs({patching, element, kind}: {patching: Patching; element: Element; kind: Kind}) {
  const {selected} = patching.panel;
  return (
    <>
      {kind.inputs.map((input) => {
        const wires = element.wires.filter((wire) => wire.port === input.name);
        return (
          <div class="port" key={input.name}>
            <b title={input.doc}>{input.name}</b> {wires.length === 0 && <span class="quiet">{input.optional ? "open" : "must be wired"}</span>}
            <ul>
              {wires.map((wire) => <WireRow key={`${wire.term} ${wire.text}`} patching={patching} element={element} wire={wire}
                isChosen={selected?.what === "input" && selected.port === wire.port && selected.term === wire.term} />)}
            </ul>
            {(input.sum || wires.length === 0) && (
              <select aria-label={`Wire to ${element.name}.${input.name}`} value="" onChange={(event) => {
                const signal = (event.target as HTMLSelectElement).value;
                if (signal) void patching.edit([{do: "connect", signal, block: element.name, port: input.name}]);
              }}>
                <option value="">wire from …</option>
                {patching.signals.map((signal) => <option value={signal}>{signal}</option>)}
              </select>
            )}
          </div>
        );
      })}
    </>
  );
}

function Outputs({session, patching, element}: {session: Session; patching: Patching; element: Element}) {
  const shown = patching.panel.sheet?.shown ?? [];
  const signals = element.outputs.length > 0 ? element.outputs.map((output) => output.signal) : [element.name];
  const {traced} = session.shown;
  return (
    <>
      {signals.map((signal) => (
        <div class="port" key={signal}>
          <b>{signal}</b>
          <button disabled={!session.channels.includes(signal) || traced.includes(signal)} onClick={() => session.trace([...traced, signal])}>scope</button>
          <button disabled={!session.channels.includes(signal)} onClick={() => void session.meter(signal)}>voltmeter</button>
          {shown.filter((output) => output.signal === signal).map((output) => (
            <span key={output.name} class="lamp">{output.name} <button class="link" aria-label={`No output ${output.name}`} onClick={() => void patching.edit([{do: "show", output: output.name, signal: ""}])}>×</button></span>
          ))}
          <Line label={`output of ${signal}`} said="" hint="name" clears title="an output of the diagram shows this signal" take={(output) => void patching.edit([{do: "show", output, signal}])} />
        </div>
      ))}
    </>
  );
}

/// What can be set of the element that is chosen; without one, of the diagram.
export function Form({session, patching}: {session: Session; patching: Patching}) {
  const {sheet, selected} = patching.panel;
  const [all, setAll] = useState(false);
  if (!sheet) return null;
  const element = selected && patching.element(selected.block);
  if (!element) {
    return (
      <div class="form" role="group" aria-label="The diagram">
        <Line label="title" said={sheet.title} take={(value) => void patching.edit([{do: "head", path: "title", value}])} />
        <Line label="runs until" said={sheet.until} hint="1" unit="s" take={(value) => void patching.edit([{do: "head", path: "run.until", value}])} />
        <p class="quiet">Choose an element to set it. A wire is dragged from an output to an input, or both are picked, by a click or the Enter key.</p>
      </div>
    );
  }
  const kind = patching.kind(element.type);
  const set = (key: string) => (value: string) => void patching.edit([{do: "set", block: element.name, key, value}]);
  const given = (name: string) => element.settings[name] ?? "";
  const parameters = kind?.parameters.filter((parameter, place) => all || place < 3 || given(parameter.name) !== "") ?? [];
  return (
    <div class="form" role="group" aria-label={`Element ${element.name}`} key={element.name}>
      <p><b>{kind?.title ?? element.type}</b> <span class="quiet">{kind?.summary}</span></p>
      {!element.known && <Line label="type" said={element.type} title="there is no such type" take={set("type")} />}
      <Line label="name" said={element.name} take={(name) => void patching.edit([{do: "rename", block: element.name, name}])} />
      <Line label="label" said={element.label} hint={element.name} take={set("label")} />
      {parameters.map((parameter) => (
        <Line key={parameter.name} label={parameter.name} said={given(parameter.name)} hint={parameter.default} unit={parameter.unit}
          title={`${parameter.doc}; ${parameter.range}`} take={set(parameter.name)} />
      ))}
      {kind && kind.parameters.length > parameters.length && <button class="link" onClick={() => setAll(true)}>all {kind.parameters.length} parameters</button>}
      {all && <button class="link" onClick={() => setAll(false)}>fewer</button>}
      {kind ? <Inputs patching={patching} element={element} kind={kind} /> : <ul>{element.wires.map((wire) => <WireRow patching={patching} element={element} wire={wire} isChosen={false} />)}</ul>}
      <Outputs session={session} patching={patching} element={element} />
      <p class="acts">
        {element.is_composite && <button onClick={() => void patching.open(element.name)}>Open</button>}
        <button onClick={() => void patching.remove(element.name)}>Delete {element.name}</button>
      </p>
    </div>
  );
}
