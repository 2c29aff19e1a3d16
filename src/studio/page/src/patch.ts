// SPDX-License-Identifier: MIT
// Patches of mechanisms, as the page shows them.
import {carried} from "./carried";
import {unpacked} from "./machine";
import type {SharedFile} from "./share";

/// The diagram of a mechanism, how its loops were judged, and its picture.
export interface Patch {
  diagram: string;
  judgement: string;
  schematic: string;  ///< SVG
}

export const usualGain = "1e5";
export const drawing = {theme: "auto", data: true};

// The engine patched the file that the page opens with when the page was built: whoever opens it need not wait for that.
let built: Promise<Patch & SharedFile> | undefined;

/// The patch of this file, as it was made with the page; nothing where it was not.
export async function ready(file: SharedFile, gain: string): Promise<Patch | undefined> {
  if (gain !== usualGain) return undefined;
  const patch = await (built ??= unpacked(carried("patch"), "application/json").json());
  return patch.name === file.name && patch.text === file.text ? patch : undefined;
}
