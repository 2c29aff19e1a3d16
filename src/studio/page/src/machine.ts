// SPDX-License-Identifier: MIT
// The worker with the engine, as functions that promise an answer.
import type {Answer, Reply} from "./answers";

/// What was packed by gzip, and written in base64.
export async function bytesOf(base64: string): Promise<ArrayBuffer> {
  const text = atob(base64);
  const zipped = new Uint8Array(text.length);
  for (let k = 0; k < text.length; ++k) zipped[k] = text.charCodeAt(k);
  const stream = new Blob([zipped]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Response(stream).arrayBuffer();
}

/// What a page carries in an element that is no script of it.
export function carried(id: string): string {
  return document.getElementById(id)?.textContent ?? "";
}

export class Stopped extends Error {}

// Of all machines: unzipped once.
let bytes: Promise<ArrayBuffer> | undefined;
let script: string | undefined;

export class Machine {
  private worker: Worker | undefined;
  private readonly asked = new Map<number, {done: (answer: Answer) => void; failed: (why: Error) => void}>();
  private next = 1;
  private ready: Promise<void> | undefined;

  start(): Promise<void> {
    bytes ??= bytesOf(carried("engine"));
    const from = script ??= URL.createObjectURL(new Blob([carried("worker")], {type: "text/javascript"}));
    this.ready = bytes.then((bytes) => new Promise((done, failed) => {
      const worker = this.worker = new Worker(from);
      worker.onerror = (event) => failed(new Error(event.message));
      worker.onmessage = (event: MessageEvent<Reply | "ready" | "failed">) => {
        if (event.data === "ready") return done();
        if (event.data === "failed") return failed(new Error("the engine does not start"));
        const waits = this.asked.get(event.data.id);
        this.asked.delete(event.data.id);
        waits?.done(event.data.answer);
      };
      worker.postMessage(bytes);
    }));
    return this.ready;
  }

  /// Rejects with Stopped where the worker was ended before it answered.
  async ask<Given extends Answer>(verb: string, ...given: unknown[]): Promise<Given> {
    await this.ready;
    const id = this.next++;
    return new Promise<Given>((done, failed) => {
      this.asked.set(id, {done: done as (answer: Answer) => void, failed});
      this.worker!.postMessage({id, verb, given});
    });
  }

  get isBusy(): boolean {
    return this.asked.size > 0;
  }

  /// Ends the worker, whatever it does, and starts another one.
  async restart(): Promise<void> {
    this.worker?.terminate();
    const waiting = [...this.asked.values()];
    this.asked.clear();
    for (const one of waiting) one.failed(new Stopped());
    await this.start();
  }
}
