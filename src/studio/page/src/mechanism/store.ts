// SPDX-License-Identifier: MIT
// A snapshot that components look at, and the machine beside the one that is held.
import {useEffect, useReducer} from "preact/hooks";

import type {Answer} from "../answers";
import {Machine, Stopped} from "../machine";

export class Store<Snapshot> {
  private readonly listeners = new Set<() => void>();

  constructor(public now: Snapshot) {}

  set(change: Partial<Snapshot>): void {
    this.now = {...this.now, ...change};
    for (const listener of this.listeners) listener();
  }

  subscribe(listener: () => void): () => void {
    this.listeners.add(listener);
    return () => { this.listeners.delete(listener); };
  }
}

export function useStore<Snapshot>(store: Store<Snapshot>): Snapshot {
  const [, again] = useReducer<number, void>((count) => count + 1, 0);
  useEffect(() => store.subscribe(() => again()), [store]);
  return store.now;
}

/// One question under way at a time, and of those that come meanwhile the newest alone.
export class Newest {
  private waits: (() => Promise<void>) | undefined;
  private running: Promise<void> | undefined;

  ask(work: () => Promise<void>): void {
    this.waits = work;
    this.running ??= this.work();
  }

  /// Resolves where nothing is under way any more.
  async idle(): Promise<void> {
    while (this.running) await this.running;
  }

  private async work(): Promise<void> {
    try {
      for (let next = this.waits; next; next = this.waits) {
        this.waits = undefined;
        try {
          await next();
        } catch (error) {
          if (!(error instanceof Stopped)) throw error;
        }
      }
    } finally {
      this.running = undefined;  // at once: what is asked from here on is no more seen above
    }
  }
}

/// An engine of its own for what takes longer than the held machine may wait: it starts when it is first asked.
export class Study {
  private machine: Machine | undefined;

  async ask<Given extends Answer>(verb: string, ...given: unknown[]): Promise<Given> {
    if (!this.machine) {
      this.machine = new Machine();
      await this.machine.start();
    }
    return this.machine.ask<Given>(verb, ...given);
  }

  /// Ends what it does; what was asked rejects with Stopped.
  async stop(): Promise<void> {
    await this.machine?.restart();
  }
}
