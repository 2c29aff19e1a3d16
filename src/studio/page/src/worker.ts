// SPDX-License-Identifier: MIT
// The engine, off the page's thread: it answers one question after the other. The page ends it where an answer takes too
// long.
import {loadEngine} from "engine";
import createEngine from "engine-glue";

import type {Answer, Question, Reply} from "./answers";

type Verb = (...given: unknown[]) => Answer;
type Held = Record<string, Verb>;
type Kind = "console" | "mechanism" | "comparison";
type Engine = Record<string, Verb> & Record<Kind, () => Held>;

let engine: Engine;
const held = {} as Record<Kind, Held>;

function answer({verb, given}: Question): Answer {
  const [kind, name] = verb.split(".", 2) as [Kind, string];
  if (name === undefined) return engine[verb]!(...given);
  held[kind] ??= engine[kind]();
  return verb === "mechanism.follow" ? held.mechanism.follow!(held.console, ...given) : held[kind][name]!(...given);
}

self.onmessageerror = () => self.postMessage("failed");
self.onmessage = async (event: MessageEvent) => {
  if (event.data instanceof WebAssembly.Module) {
    try {
      engine = await loadEngine({createEngine, wasmModule: event.data, limits: {seconds: 20}}) as unknown as Engine;
      held.console = engine.console();
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
