// SPDX-License-Identifier: MIT
import {useRef} from "preact/hooks";

import type {Diagnostic} from "./answers";
import {useShown, type Session} from "./session";

/// What the engine found, by lines; a click leads there.
function Findings({of, goTo}: {of: Diagnostic[]; goTo: (line: number, column: number) => void}) {
  return (
    <ul class="findings" role="alert">
      {of.map((finding) => (
        <li>
          {finding.line > 0 && <button class="link" onClick={() => goTo(finding.line, finding.column)}>line {finding.line}</button>} {finding.what}
          {finding.expected && <>; expected {finding.expected}</>}
          {finding.remedy && <div class="remedy">{finding.remedy}</div>}
        </li>
      ))}
    </ul>
  );
}

/// The text of the file, what is wrong with it by lines, and what else there is to say.
export function Editor({session}: {session: Session}) {
  const written = useShown(session, (shown) => shown.written);
  const findings = useShown(session, (shown) => shown.findings);
  const remarks = useShown(session, (shown) => shown.remarks);
  const area = useRef<HTMLTextAreaElement>(null);
  const goTo = (line: number, column: number) => {
    const lines = written.split("\n");
    const at = lines.slice(0, line - 1).reduce((sum, text) => sum + text.length + 1, 0) + Math.max(column - 1, 0);
    area.current?.focus();
    area.current?.setSelectionRange(at, at + Math.max(1, (lines[line - 1] ?? "").length - Math.max(column - 1, 0)));
  };
  return (
    <section class="text" aria-label="File">
      <textarea ref={area} spellcheck={false} aria-label="Text of the file" value={written} onInput={(event) => session.write((event.target as HTMLTextAreaElement).value)} />
      {findings.length > 0 && <Findings of={findings} goTo={goTo} />}
      {remarks.map((remark) => <p class="remark">{remark}</p>)}
    </section>
  );
}
