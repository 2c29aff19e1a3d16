// SPDX-License-Identifier: MIT
import {useEffect} from "preact/hooks";

import {keysOf, Lamps, Meter, Modes, Pots} from "./controls";
import {Editor} from "./editor";
import {MechanismRoom} from "./mechanism/room";
import {Scope} from "./scope";
import {examples, useShown, type Session} from "./session";
import {save, toFragment} from "./share";

function Header({session}: {session: Session}) {
  const title = useShown(session, (shown) => shown.title);
  const file = useShown(session, (shown) => shown.file);
  const engine = useShown(session, (shown) => shown.engine);
  const busy = useShown(session, (shown) => shown.busy);

  async function pick(event: Event): Promise<void> {
    const chosen = (event.target as HTMLInputElement).files?.[0];
    if (chosen) await session.load({name: chosen.name, text: await chosen.text()});
  }
  function choose(name: string): void {
    const example = examples.find((one) => one.name === name);
    if (example) void session.load(example);
  }
  async function share(): Promise<void> {
    location.hash = await toFragment({name: file.name, text: session.shown.written});
    await navigator.clipboard?.writeText(location.href).catch(() => undefined);
    session.set({remarks: ["the link in the address bar holds the file"]});
  }

  return (
    <header>
      <h1>Oblique <span class="quiet">{title}</span></h1>
      <label>Example <select aria-label="Examples" onChange={(event) => choose((event.target as HTMLSelectElement).value)} value={file.name}>
        <option value="">…</option>
        {examples.map((one) => <option value={one.name}>{one.name.replace(/\.toml$/, "").replaceAll("/", ": ")}</option>)}
      </select></label>
      <label class="button">Open <input type="file" accept=".toml" onChange={(event) => void pick(event)} /></label>
      <button onClick={() => save(file.name.split("/").pop() || "machine.toml", session.shown.written, "text/plain")}>Save</button>
      <button onClick={() => void share()}>Link</button>
      <span class="state" data-state={engine}>{engine === "starting" ? "the engine starts …" : busy ? "computing …" : ""}</span>
      <button class="stop" disabled={!busy} onClick={() => void session.stop()}>Stop</button>
    </header>
  );
}

function Pictures({session}: {session: Session}) {
  const schematic = useShown(session, (shown) => shown.schematic);
  return (
    <section class="machine">
      <MechanismRoom session={session} />
      <div class="picture schematic" dangerouslySetInnerHTML={{__html: schematic}} />
    </section>
  );
}

export function App({session}: {session: Session}) {
  const engine = useShown(session, (shown) => shown.engine);
  useEffect(() => {
    const keys = (event: KeyboardEvent) => keysOf(session, event);
    addEventListener("keydown", keys);
    return () => removeEventListener("keydown", keys);
  }, [session]);

  if (engine === "failed") return <p class="failed">This browser cannot run the engine: it needs WebAssembly with exceptions (Firefox 100, Chrome 95, Safari 15.2, or later).</p>;
  return (
    <>
      <Header session={session} />
      <main>
        <Editor session={session} />
        <Pictures session={session} />
        <section class="desk" aria-label="Console">
          <Modes session={session} />
          <Lamps session={session} />
          <Scope session={session} />
          <Meter session={session} />
          <Pots session={session} />
        </section>
      </main>
    </>
  );
}
