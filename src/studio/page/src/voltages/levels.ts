// SPDX-License-Identifier: MIT
import type {Answer} from "../answers";
import type {Companion, Session} from "../session";

/// The values of all signals of the machine [machine unit], read once a frame while somebody looks at them.
export class Levels implements Companion {
  private values: Float64Array = new Float64Array(0);
  private places = new Map<string, number>();
  private lookers = 0;
  private of: unknown;

  constructor(private readonly session: Session) {}

  /// NaN for a signal that there is not.
  at(signal: string): number {
    return this.values[this.places.get(signal) ?? -1] ?? NaN;
  }

  has(signal: string): boolean {
    return this.places.has(signal);
  }

  /// From now on somebody looks, until what this gives is called.
  look(): () => void {
    ++this.lookers;
    void this.went().catch(() => undefined);  // a machine that was stopped is opened again
    return () => { --this.lookers; };
  }

  async opened(): Promise<void> {
    await this.went();
  }

  async went(): Promise<void> {
    const {held} = this.session.shown;
    if (this.lookers === 0 || !held) return;
    const read = await this.session.machine.ask<Answer>("console.signals");
    if (!read.ok || held !== this.session.shown.held) return;
    if (this.of !== held) this.places = new Map(held.signals.map((name, k) => [name, k]));
    this.of = held;
    this.values = read.numbers;
    this.session.set({levels: this.session.shown.levels + 1});
  }
}
