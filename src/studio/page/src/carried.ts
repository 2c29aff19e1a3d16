// SPDX-License-Identifier: MIT
// What the page carries in elements that are no scripts of it.

declare global {
  var earlyWorker: Worker | undefined;  ///< the first one, as early.ts leaves it
}

export function carried(id: string): string {
  return document.getElementById(id)?.textContent ?? "";
}

export function newWorker(): Worker {
  return new Worker(URL.createObjectURL(new Blob([carried("worker")], {type: "text/javascript"})));
}
