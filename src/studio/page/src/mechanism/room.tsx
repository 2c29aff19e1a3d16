// SPDX-License-Identifier: MIT
import {useMemo} from "preact/hooks";

import {useShown, type Session} from "../session";
import {Convergence} from "./convergence";
import {Desk} from "./desk";
import {Drive} from "./drive";
import {LoopsPanel} from "./loops";
import {AssemblyModes} from "./modes";
import {LinkageView} from "./view";

/// All that the page has of the mechanism of its machine.
export function MechanismRoom({session}: {session: Session}) {
  const desk = useMemo(() => new Desk(session), [session]);
  const kind = useShown(session, (shown) => shown.kind);
  if (kind !== "mechanism") return null;
  return (
    <section class="mechanism" aria-label="Mechanism">
      <LinkageView desk={desk} />
      <Drive desk={desk} />
      <AssemblyModes desk={desk} />
      <LoopsPanel desk={desk} />
      <Convergence desk={desk} />
    </section>
  );
}
