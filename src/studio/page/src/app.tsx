// SPDX-License-Identifier: MIT
import {useEffect, useMemo} from "preact/hooks";

import {keysOf, Lamps, Meter, Modes, Pots} from "./controls";
import {Editor} from "./editor";
import {Lesson} from "./lesson";
import {MechanismRoom} from "./mechanism/room";
import {PatchPanel} from "./panel/panel";
import {Patching} from "./panel/patching";
import {Scope} from "./scope/scope";
import {useShown, type Session} from "./session";
import {save, toFragment} from "./share";

function Header({session, patching}: {session: Session; patching: Patching}) {
  const title = useShown(session, (shown) => shown.title);
  const file = useShown(session, (shown) => shown.file);
  const engine = useShown(session, (shown) => shown.engine);
  const examples = useShown(session, (shown) => shown.examples);
  const folders = [...new Set(examples.map(({name}) => name.split("/")[0]!))];
  const busy = useShown(session, (shown) => shown.busy);

  async function pick(event: Event): Promise<void> {
    const chosen = (event.target as HTMLInputElement).files?.[0];
    if (chosen) await session.load(chosen.text().then((text) => ({name: chosen.name, text})));
  }
  function choose(name: string): void {
    const example = examples.find((one) => one.name === name);
    if (example) void session.load(example);
  }
  async function share(): Promise<void> {
    location.hash = await toFragment({...session.source, text: session.shown.written});
    await navigator.clipboard?.writeText(location.href).catch(() => undefined);
    session.set({remarks: ["the link in the address bar holds the file"]});
  }

  return (
    <header>
      <h1>Oblique <span class="quiet">{title}</span></h1>
      <label>Example <select aria-label="Examples" onChange={(event) => choose((event.target as HTMLSelectElement).value)} value={file.name}>
        <option value="">…</option>
        {folders.map((folder) => (
          <optgroup label={folder}>
            {examples.filter((one) => one.name.startsWith(`${folder}/`)).map((one) => (
              <option value={one.name}>{one.name.slice(folder.length + 1).replace(/\.toml$/, "")}</option>
            ))}
          </optgroup>
        ))}
      </select></label>
      <button onClick={() => patching.begin()}>New</button>
      <label class="button">Open <input type="file" accept=".toml" onChange={(event) => void pick(event)} /></label>
      <button onClick={() => save(session.source.name.split("/").pop() || "machine.toml", session.shown.written, "text/plain")}>Save</button>
      <button onClick={() => void share()}>Link</button>
      <span class="state" data-state={engine}>{engine === "starting" ? "the engine starts …" : busy ? "computing …" : ""}</span>
      <button class="stop" disabled={!busy} onClick={() => void session.stop()}>Stop</button>
    </header>
  );
}

function Pictures({session, patching}: {session: Session; patching: Patching}) {
  return (
    <section class="machine">
      <MechanismRoom session={session} />
      <PatchPanel session={session} patching={patching} />
    </section>
  );
}

export function App({session}: {session: Session}) {
  const engine = useShown(session, (shown) => shown.engine);
  const patching = useMemo(() => new Patching(session), [session]);
  useEffect(() => {
    const keys = (event: KeyboardEvent) => keysOf(session, event);
    addEventListener("keydown", keys);
    return () => removeEventListener("keydown", keys);
  }, [session]);

  if (engine === "failed") return <p class="failed">This browser cannot run the engine: it needs WebAssembly with exceptions, and streams that unpack (Firefox 113, Chrome 103, Safari 16.4, or later).</p>;
  return (
    <>
      <Header session={session} patching={patching} />
      <main>
        <div class="papers">
          <Lesson session={session} />
          <Editor session={session} />
        </div>
        <Pictures session={session} patching={patching} />
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
