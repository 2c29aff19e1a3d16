// SPDX-License-Identifier: MIT
// The worker with the engine, as functions that promise an answer.
import type {Answer, Reply} from "./answers";
import {carried, newWorker} from "./carried";

const piece = 1 << 17;  // characters of base64 that are unpacked in one go: whole groups of four

/// What was packed by gzip, and written in base64, as it is unpacked.
export function unpacked(base64: string, type: string): Response {
  let at = 0;
  const zipped = new ReadableStream<BufferSource>({
    pull(taker) {
      const text = atob(base64.slice(at, at += piece)), bytes = new Uint8Array(text.length);
      for (let k = 0; k < text.length; ++k) bytes[k] = text.charCodeAt(k);
      taker.enqueue(bytes);
      if (at >= base64.length) taker.close();
    },
  });
  return new Response(zipped.pipeThrough(new DecompressionStream("gzip")), {headers: {"Content-Type": type}});
}

// Rejects, too, where the browser has not what it needs.
async function compiled(): Promise<WebAssembly.Module> {
  return WebAssembly.compileStreaming(unpacked(carried("engine"), "application/wasm"));
}

export class Stopped extends Error {}

// Of all machines: compiled once, while it is unpacked.
let engine: Promise<WebAssembly.Module> | undefined;

export class Machine {
  private worker: Worker | undefined;
  private readonly asked = new Map<number, {done: (answer: Answer) => void; failed: (why: Error) => void}>();
  private next = 1;
  private ready: Promise<void> | undefined;
  /// How many workers it has had: what one was told the next one does not know.
  starts = 0;

  start(): Promise<void> {
    ++this.starts;
    engine ??= compiled();
    const worker = this.worker = globalThis.earlyWorker ?? newWorker();  // it reads its script meanwhile
    globalThis.earlyWorker = undefined;
    this.ready = new Promise((done, failed) => {
      worker.onerror = (event) => failed(new Error(event.message));
      worker.onmessage = (event: MessageEvent<Reply | "ready" | "failed">) => {
        if (event.data === "ready") return done();
        if (event.data === "failed") return failed(new Error("the engine does not start"));
        const waits = this.asked.get(event.data.id);
        this.asked.delete(event.data.id);
        waits?.done(event.data.answer);
      };
      engine!.then((module) => worker.postMessage(module), failed);
    });
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
