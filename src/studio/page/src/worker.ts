// SPDX-License-Identifier: MIT
// The engine, off the page's thread: it answers one question after the other. The page ends it where an answer takes too
// long.
import {loadEngine} from "engine";
import createEngine from "engine-glue";

import type {Answer, Question, Reply} from "./answers";

type Verb = (...given: unknown[]) => Answer;
type Held = Record<string, Verb>;
type Engine = Record<string, Verb> & {console: () => Held};

let engine: Engine;
let held: Held;

function answer({verb, given}: Question): Answer {
  const [object, name] = verb.startsWith("console.") ? [held, verb.slice("console.".length)] : [engine, verb];
  return object[name]!(...given);
}

self.onmessage = async (event: MessageEvent) => {
  if (event.data instanceof ArrayBuffer) {
    try {
      engine = await loadEngine({createEngine, wasmBinary: new Uint8Array(event.data), limits: {seconds: 20}}) as unknown as Engine;
      held = engine.console();
      self.postMessage("ready");
    } catch {
      self.postMessage("failed");
    }
    return;
  }
  const question = event.data as Question;
  const reply: Reply = {id: question.id, answer: answer(question)};
  self.postMessage(reply, {transfer: [reply.answer.numbers.buffer]});
};
