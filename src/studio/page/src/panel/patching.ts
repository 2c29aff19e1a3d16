// SPDX-License-Identifier: MIT
// The hand at the patch panel: what it does to the file, and to the machine that runs meanwhile.
import type {Answer, Diagnostic, Drawn} from "../answers";
import {Stopped} from "../machine";
import type {Session} from "../session";
import type {SharedFile} from "../share";
import {History, thenRenamed} from "./history";
import {type At, type Edited, type Element, type Grip, type Kind, type Kinds, placeUnit, type Sheet, type Step} from "./sheet";

const restOfTyping = 1000;  // ms; what is typed after it is another step to be undone

const emptyFile: SharedFile = {name: "new.toml", text: `format = "oblique-diagram/1"
title  = "New diagram"

[run]
until = 10

[blocks]
`};

export interface Panel {
  sheet: Sheet | undefined;       ///< of the text as it stands, or the last one that could be read
  isOld: boolean;                 ///< the text cannot be read any more
  selected: Grip | undefined;
  from: string;                   ///< the signal that is about to be wired
  refusal: Diagnostic[];          ///< of the last thing that was tried
  inside: {path: string; svg: string} | undefined;
  kinds: Kind[];
  canUndo: boolean;
  canRedo: boolean;
}

export class Patching {
  panel: Panel = {sheet: undefined, isOld: false, selected: undefined, from: "", refusal: [], inside: undefined, kinds: [], canUndo: false, canRedo: false};
  private readonly history = new History();
  private readonly listeners = new Set<() => void>();
  private known = "";                         // the text that the history knows
  private held = "";                          // the block that the hand has moved last
  private taken: SharedFile | undefined;      // the file that the machine is of
  private queue: Promise<unknown> = Promise.resolve();
  private later: ReturnType<typeof setTimeout> | undefined;

  constructor(private readonly session: Session) {
    session.subscribe(() => this.look());
    this.look();
  }

  subscribe(listener: () => void): () => void {
    this.listeners.add(listener);
    return () => { this.listeners.delete(listener); };
  }

  set(change: Partial<Panel>): void {
    this.panel = {...this.panel, ...change, canUndo: this.history.canUndo, canRedo: this.history.canRedo};
    for (const listener of this.listeners) listener();
  }

  kind(type: string): Kind | undefined {
    return this.panel.kinds.find((one) => one.name === type);
  }
  element(name: string): Element | undefined {
    return this.panel.sheet?.blocks.find((one) => one.name === name);
  }
  get signals(): string[] {
    const drawn = this.panel.sheet?.blocks.flatMap((block) => block.outputs.map((output) => output.signal)) ?? [];
    const atInputs = this.panel.sheet?.blocks.filter((block) => !block.body).map((block) => block.name) ?? [];
    return [...atInputs, ...drawn];
  }

  /// Does these steps as one that can be undone. Whether they could be done.
  edit(steps: Step[], held = ""): Promise<boolean> {
    return this.queued(async () => {
      const {session} = this;
      const file = {...session.source, text: session.shown.written};
      const made = await session.machine.ask<Edited>("edit", file.text, {steps}, file.name);
      if (!this.done(made)) return false;
      let {text} = made;
      this.held = held === "added" ? made.added : held;
      let sheet = await session.machine.ask<Sheet>("panel", text, {held: this.held, data: true}, file.name);
      if (!this.done(sheet)) return false;
      if (sheet.moved.length > 0) {
        const apart = await session.machine.ask<Edited>("edit", text, {steps: [{do: "place", places: sheet.moved}]}, file.name);
        if (!this.done(apart)) return false;
        ({text} = apart);
        sheet = await session.machine.ask<Sheet>("panel", text, {held: this.held, data: true}, file.name);
      }
      if (text === file.text) return true;
      const next = {...file, text};
      this.history.add(next, made.renamed);
      const {selected} = this.panel;
      const now = (name: string) => made.renamed.find(([before]) => before === name)?.[1] ?? name;
      this.set({sheet, isOld: false, refusal: [], inside: undefined,
        selected: made.added ? {what: "block", block: made.added} : selected && {...selected, block: now(selected.block)}});
      await this.take(next, made.renamed);
      return true;
    });
  }

  /// Adds an element, at a place of the picture.
  add(type: string, at: At): Promise<boolean> {
    return this.edit([...this.keptPlaces(), {do: "add", type}, {do: "place", places: [{at: this.placeAt(at)}]}], "added");
  }
  move(block: string, by: At): Promise<boolean> {
    const element = this.element(block);
    if (!element?.body) return Promise.resolve(false);
    const at = element.place.map((place, k) => Math.round((place + by[k]! / placeUnit) * 2) / 2);
    return this.edit([...this.keptPlaces(), {do: "place", places: [{name: block, at}]}], block);
  }
  remove(block: string): Promise<boolean> {
    this.set({selected: undefined, from: ""});
    return this.edit([{do: "remove", block}]);
  }

  /// Wires a signal to a pin, or to the input of a block that is next: one that must be wired, one that adds, any that is
  /// free.
  wire(signal: string, to: Grip): Promise<boolean> {
    this.set({from: ""});
    const element = this.element(to.block);
    const kind = element && this.kind(element.type);
    if (!element || !kind) return Promise.resolve(false);
    let port = to.what === "input" ? to.port : undefined;
    port ??= element.open[0]?.port ?? kind.inputs.find((input) => input.sum)?.name
      ?? kind.inputs.find((input) => !element.wires.some((wire) => wire.port === input.name))?.name ?? kind.inputs[0]?.name;
    if (port === undefined) {
      this.refuse(`${kind.title.toLowerCase()} '${element.name}' has no inputs`);
      return Promise.resolve(false);
    }
    return this.edit([{do: "connect", signal, block: to.block, port}]);
  }
  cut(block: string, port: string, term: number): Promise<boolean> {
    return this.edit([{do: "disconnect", block, port, term}]);
  }

  undo(): Promise<boolean> {
    return this.queued(() => this.goTo(this.history.undo()));
  }
  redo(): Promise<boolean> {
    return this.queued(() => this.goTo(this.history.redo()));
  }

  /// An empty diagram in place of what is here.
  begin(): void {
    const {session} = this;
    void session.clear();
    void session.load(emptyFile).then(() => { if (session.shown.written === emptyFile.text) session.set({findings: []}); });  // that it is empty is meant
  }

  /// The patch of a mechanism becomes a diagram of one's own.
  async editPatch(): Promise<void> {
    const {file, diagram} = this.session.shown;
    await this.session.load({name: file.name.replace(/^.*\//, "").replace(/(\.toml)?$/, "-patch.toml"), text: diagram});
  }

  async open(path: string): Promise<void> {
    if (path === "") return this.set({inside: undefined});
    const drawn = await this.session.machine.ask<Drawn>("inside", this.session.shown.written, {path, data: true}, this.session.source.name);
    if (this.done(drawn)) this.set({inside: {path, svg: drawn.svg}});
  }

  /// Some words about what cannot be done.
  refuse(what: string): void {
    this.set({refusal: [{file: "", line: 0, column: 0, what, expected: "", remedy: "", message: what}]});
  }

  private done(answer: Answer): boolean {
    if (!answer.ok) this.set({refusal: answer.diagnostics ?? []});
    return answer.ok;
  }

  /// One after the other, in the order in which they were asked for.
  private queued(work: () => Promise<boolean>): Promise<boolean> {
    const mine = this.queue.then(work).catch((error) => {
      if (!(error instanceof Stopped)) throw error;
      return false;
    });
    this.queue = mine;
    return mine;
  }

  private placeAt([x, y]: At): At {
    const origin = this.panel.sheet?.origin ?? [24, 24];
    return [Math.round((x - origin[0]) / placeUnit * 2) / 2, Math.round((y - origin[1]) / placeUnit * 2) / 2];
  }

  /// Where one element has a place of its own, all of them keep theirs.
  private keptPlaces(): Step[] {
    const places = (this.panel.sheet?.blocks ?? []).filter((block) => block.body && !block.placed).map((block) => ({name: block.name, at: block.place}));
    return places.length > 0 ? [{do: "place", places}] : [];
  }

  private async goTo(version: {file: SharedFile; renamed: [string, string][]} | undefined): Promise<boolean> {
    if (!version) return false;
    this.set({refusal: [], from: "", inside: undefined});
    await this.take(version.file, version.renamed);
    await this.draw();
    return true;
  }

  /// Lets the machine have a file.
  private async take(file: SharedFile, renamed: [string, string][]): Promise<void> {
    const {session} = this;
    session.renamed = thenRenamed(session.renamed, renamed);
    this.known = file.text;
    session.source = file;
    session.set({written: file.text});
    await session.open(file, {keeps: true});
  }

  /// Notices what else has changed the text: what is typed, and files that are opened.
  private look(): void {
    const {written, engine, file: taken} = this.session.shown;
    if (taken !== this.taken && taken.blocks?.length) {  // kinds of its own have come with it
      this.panel.kinds = [];
      setTimeout(() => void this.queued(() => this.draw()), 0);
    }
    this.taken = taken;
    if (engine !== "ready" || written === this.known) return;
    const isTyped = this.history.now?.file.name === this.session.source.name && this.session.typed === written;
    this.known = written;
    const file = {...this.session.source, text: written};
    if (isTyped) {
      this.history.type(file, performance.now(), restOfTyping);
    } else {
      this.history.add(file);
      this.session.renamed = [];
    }
    this.held = "";
    this.set(isTyped ? {refusal: []} : {refusal: [], selected: undefined, from: "", inside: undefined});
    clearTimeout(this.later);
    this.later = setTimeout(() => void this.queued(() => this.draw()), isTyped ? 200 : 0);
  }

  /// The panel of the text as it stands.
  private async draw(): Promise<boolean> {
    const {machine, source, shown} = this.session;
    const sheet = await machine.ask<Sheet>("panel", shown.written, {held: this.held, data: true}, source.name);
    if (sheet.ok && this.panel.kinds.length === 0) {
      const kinds = await machine.ask<Kinds>("blocks");
      if (kinds.ok) this.set({kinds: kinds.blocks});
    }
    const isMechanism = !sheet.ok && /is a mechanism/.test(sheet.diagnostics?.[0]?.what ?? "");
    if (sheet.ok) this.set({sheet, isOld: false});
    else this.set(isMechanism ? {sheet: undefined, isOld: false} : {isOld: true});
    return sheet.ok;
  }
}
