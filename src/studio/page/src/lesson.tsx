// SPDX-License-Identifier: MIT
// A lesson beside the machine, a step at a time: what to turn, what should be seen, and whether it is.
import {useEffect, useState} from "preact/hooks";

import type {Checked, Lesson as Taught, LessonStep} from "./answers";
import {short} from "./numbers";
import {useShown, type Session} from "./session";

/// Paragraphs are parted by empty lines.
function Paragraphs({text}: {text: string}) {
  return <>{text.split(/\n\s*\n/).filter((one) => one.trim() !== "").map((one) => <p>{one}</p>)}</>;
}

function Verdict({checked}: {checked: Checked}) {
  return (
    <ul class="verdict" role="status">
      {checked.checks.map((one) => (
        <li class={one.met ? "met" : "missed"}>
          <b>{one.met ? "✓ seen" : "✗ not yet"}</b> {one.what}: {short(one.actual)}{!one.met && <> where {short(one.value)} ± {short(one.within)} should be</>}
        </li>
      ))}
    </ul>
  );
}

function Step({session, step, number}: {session: Session; step: LessonStep; number: number}) {
  const [checked, setChecked] = useState<Checked>();
  return (
    <>
      <Paragraphs text={step.do} />
      {step.guess && <p><b>Guess first:</b> {step.guess}</p>}
      {step.set.length > 0 && (
        <p><button onClick={() => void session.setFor(step.set)}>Set it for me</button> <span class="quiet">{step.set.map(({name, value}) => `${name} = ${value}`).join(", ")}</span></p>
      )}
      {step.guess ? <details><summary>What is seen</summary><Paragraphs text={step.see} /></details> : <Paragraphs text={step.see} />}
      {step.checked && <p><button onClick={() => void session.checkLesson(number).then(setChecked)}>Check</button></p>}
      {checked && <Verdict checked={checked} />}
    </>
  );
}

function Question({session, question}: {session: Session; question: NonNullable<Taught["question"]>}) {
  const [given, setGiven] = useState("");
  const [met, setMet] = useState<boolean>();
  const answer = async (event: Event) => {
    event.preventDefault();
    setMet((await session.checkLesson(undefined, {name: question.answer, value: given.trim()}))?.met);
  };
  return (
    <form onSubmit={(event) => void answer(event)}>
      <Paragraphs text={question.ask} />
      <p><label>{question.answer} = <input type="text" value={given} onInput={(event) => setGiven((event.target as HTMLInputElement).value)} /></label> <button type="submit" disabled={given.trim() === ""}>Answer</button></p>
      <div role="status">
        {met === true && <p class="met"><b>✓ right</b></p>}
        {met === false && <p class="missed"><b>✗ wrong</b> {question.hint}</p>}
      </div>
    </form>
  );
}

export function Lesson({session}: {session: Session}) {
  const lesson = useShown(session, (shown) => shown.lesson);
  const file = useShown(session, (shown) => shown.file.name);
  const [at, setAt] = useState(0);
  useEffect(() => setAt(0), [file]);
  if (!lesson) return null;
  const last = lesson.steps.length + (lesson.question ? 1 : 0);
  const step = lesson.steps[at - 1];
  return (
    <section class="lesson" aria-label="Lesson">
      {lesson.title && <h2>{lesson.title}</h2>}
      <div class="lesson-steps" role="group" aria-label="Steps of the lesson">
        <button disabled={at === 0} onClick={() => setAt(at - 1)}>Back</button>
        <output>{at === 0 ? "to begin with" : step ? `step ${at} of ${lesson.steps.length}` : "a question"}</output>
        <button disabled={at === last} onClick={() => setAt(at + 1)}>Next</button>
      </div>
      {at === 0 ? <Paragraphs text={lesson.text} /> : step ? <Step key={`${file} ${at}`} session={session} step={step} number={at} /> : <Question key={file} session={session} question={lesson.question!} />}
    </section>
  );
}
