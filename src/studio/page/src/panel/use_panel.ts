// SPDX-License-Identifier: MIT
import {useEffect, useReducer} from "preact/hooks";

import type {Panel, Patching} from "./patching";

/// What stands at the panel; the component is drawn anew when it changes.
export function usePanel(patching: Patching): Panel {
  const [, again] = useReducer<number, void>((count) => count + 1, 0);
  useEffect(() => patching.subscribe(() => again()), [patching]);
  return patching.panel;
}
