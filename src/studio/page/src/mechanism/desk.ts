// SPDX-License-Identifier: MIT
// The mechanism of the machine that is held: where it stands exactly and as the machine has it, and how it is dragged.
import type {Answer} from "../answers";
import {Stopped} from "../machine";
import {runs, type Mode, type Session} from "../session";
import type {DraggedAnswer, Events, Met, Nearest, OpenedMechanism, Position} from "./answers";
import {Newest, Store, Study} from "./store";

export interface Dragging {
  point: string;
  x: number;           ///< where it is wanted, in the picture
  y: number;
  svg: string;         ///< of the mechanism with other lengths; empty while these are locked
  changed: {name: string; before: number; after: number}[];
  why: string;         ///< it cannot be there
}

export interface DeskShown {
  mechanism: OpenedMechanism | undefined;
  position: Position | undefined;
  events: Met[] | undefined;
  from: number;        ///< the way of the drive
  to: number;
  magnification: number;
  locked: boolean;
  dragging: Dragging | undefined;
}

const none: DeskShown = {mechanism: undefined, position: undefined, events: undefined, from: 0, to: 0, magnification: 1000, locked: true, dragging: undefined};

/// The file whose mechanism the engine holds, and the worker that does.
interface Opened {
  name: string;
  text: string;
  starts: number;
}

export class Desk extends Store<DeskShown> {
  readonly study = new Study();
  private readonly follows = new Newest();
  private readonly drags = new Newest();
  private held: unknown;       // the machine of the session
  private opened: Opened | undefined;
  private drawn = -1;
  private fits = "";           // the diagram whose magnification was found
  private resumes: Mode = "hold";
  private edited: DraggedAnswer | undefined;
  private operated = 0;        // for how long the machine has been in operation [s]

  constructor(readonly session: Session) {
    super(none);
    session.subscribe(() => this.look());
  }

  /// Follows what the session shows.
  private look(): void {
    const {shown} = this.session;
    if (shown.kind !== "mechanism") {
      if (this.now.mechanism) this.set({...none, magnification: this.now.magnification, locked: this.now.locked});
      this.held = shown.held;
      this.opened = undefined;
      return;
    }
    const isOther = shown.held !== this.held;
    if (isOther || (shown.drawn !== this.drawn && !this.now.dragging)) this.follows.ask(() => this.follow());
    this.held = shown.held;
    this.drawn = shown.drawn;
  }

  private ask<Given extends Answer>(verb: string, ...given: unknown[]): Promise<Given> {
    return this.session.machine.ask<Given>(verb, ...given);
  }

  /// Has the engine hold the mechanism of the file, where it does not yet. A machine that begins again, or is patched anew, has
  /// the same one: what is in the hand stays there. Where another one stands, if one was opened.
  private async open(): Promise<Position | undefined> {
    const {file: {name, text}, kind} = this.session.shown, {starts} = this.session.machine, before = this.opened;
    if (kind !== "mechanism") return undefined;
    const isSame = before?.name === name && before.text === text;
    if (isSame && before.starts === starts) return undefined;
    const mechanism = await this.ask<OpenedMechanism>("mechanism.open", text, name);
    if (!mechanism.ok) return undefined;
    const mine = this.opened = {name, text, starts};
    if (isSame) return undefined;
    const position = await this.ask<Position>("mechanism.follow", this.now.magnification);
    if (this.opened !== mine) return undefined;
    this.set({mechanism, position: position.ok ? position : undefined, events: undefined, dragging: undefined});  // at once: both are of one picture
    // what is met takes the way of a whole round: after the page can be used
    setTimeout(() => void this.meet(mechanism).catch(ignoreStops), 200);
    return position;
  }

  private async meet(mechanism: OpenedMechanism): Promise<void> {
    const met = await this.ask<Events>("mechanism.events");
    if (met.ok && this.now.mechanism === mechanism) this.set({events: met.events, from: met.from, to: met.to});
  }

  private async follow(): Promise<void> {
    const position = await this.open() ?? await this.ask<Position>("mechanism.follow", this.now.magnification);
    if (!position.ok) return;
    const {diagram, time} = this.session.shown;
    if (this.fits !== diagram && position.suggested && time > 0) {
      this.magnify(Math.min(1e6, Math.max(1, position.suggested)));
    }
    this.operated = position.time;
    if (!this.now.dragging) this.set({position});
  }

  magnify(magnification: number): void {
    this.fits = this.session.shown.diagram;
    this.set({magnification});
    this.follows.ask(() => this.follow());
  }

  /// A point is taken hold of: the machine stands meanwhile, and does afterwards what it did.
  async take(point: string): Promise<void> {
    const {mode} = this.session.shown;
    this.resumes = mode;
    this.edited = undefined;
    const at = this.placeOf(point);
    if (!at) return;
    this.set({dragging: {point, x: at[0], y: at[1], svg: "", changed: [], why: ""}});
    if (runs(mode)) await this.session.press("hold");
  }

  /// Where a point of the exact mechanism is in the picture.
  placeOf(point: string): [number, number] | undefined {
    const {mechanism, position} = this.now;
    const k = mechanism?.points.findIndex(({name}) => name === point) ?? -1;
    if (!position || k < 0 || Number.isNaN(position.numbers[2 * k]!)) return undefined;
    return [position.numbers[2 * k]!, position.numbers[2 * k + 1]!];
  }

  drag(x: number, y: number): void {
    const {dragging} = this.now;
    if (!dragging) return;
    this.set({dragging: {...dragging, x, y}});
    this.drags.ask(() => (this.now.locked ? this.turn(x, y) : this.stretch(x, y)));
  }

  /// With its lengths locked the mechanism goes where the point is nearest, and the machine with it.
  private async turn(x: number, y: number): Promise<void> {
    const {dragging, position} = this.now;
    if (!dragging || !position) return;
    await this.open();
    const nearest = await this.ask<Nearest>("mechanism.nearest", dragging.point, x, y, position.time);
    if (!nearest.ok) return this.fail(nearest);
    const at = await this.ask<Position>("mechanism.at", nearest.time);
    if (at.ok) this.set({position: at});
    await this.session.goTo(nearest.time, this.operated);
    const followed = await this.ask<Position>("mechanism.follow", this.now.magnification);
    if (!followed.ok) return;
    this.operated = followed.time;
    this.set({position: followed});
  }

  /// With its lengths free the links that carry the point get others; the numbers of the file change.
  private async stretch(x: number, y: number): Promise<void> {
    const {dragging, position} = this.now;
    if (!dragging || !position) return;
    await this.open();
    const dragged = await this.ask<DraggedAnswer>("mechanism.drag", dragging.point, x, y, position.time);
    if (!dragged.ok) return this.fail(dragged);
    this.edited = dragged;
    if (!this.now.dragging) return;
    this.set({dragging: {...this.now.dragging, svg: dragged.svg, changed: dragged.changed, why: ""}});
    this.session.set({written: dragged.text});
  }

  private fail(answer: Answer): void {
    if (this.now.dragging) this.set({dragging: {...this.now.dragging, why: answer.diagnostics?.[0]?.what ?? ""}});
  }

  /// The point is let go.
  async drop(): Promise<void> {
    if (!this.now.dragging) return;
    await this.drags.idle();
    const {edited} = this;
    this.set({dragging: undefined});
    if (edited && edited.changed.length > 0) await this.takeOver(edited);
    if (runs(this.resumes) && !runs(this.session.shown.mode)) await this.session.press("operate");
    this.follows.ask(() => this.follow());
  }

  /// The machine of the changed file goes on where the drive stands.
  private async takeOver(edited: DraggedAnswer): Promise<void> {
    const {file} = this.session.shown;
    if (!(await this.session.load({name: file.name, text: edited.text}))) return;
    this.follows.ask(() => this.follow());
    await this.follows.idle();
    const {time} = await this.ask<Answer & {time: number | null}>("mechanism.timeOf", edited.drive);
    if (time !== null && time > 0) await this.session.goTo(time, 0);
  }

  /// By arrow keys: so far [px] from where the point stands.
  async nudge(point: string, dx: number, dy: number): Promise<void> {
    const at = this.placeOf(point);
    if (!at || this.now.dragging) return;
    await this.take(point);
    this.drag(at[0] + dx, at[1] + dy);
    await this.drop();
  }
}

function ignoreStops(error: unknown): void {
  if (!(error instanceof Stopped)) throw error;
}
