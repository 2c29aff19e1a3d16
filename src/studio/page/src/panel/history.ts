// SPDX-License-Identifier: MIT
import type {SharedFile} from "../share";

/// A file as it once was, and what was renamed on the way to it from the one before.
export interface Version {
  file: SharedFile;
  renamed: [string, string][];
}

const mostVersions = 1000, mostText = 50e6;

/// What was done, so that it can be undone. Some characters typed one after the other are one step.
export class History {
  private versions: Version[] = [];
  private place = -1;
  private typed = -Infinity;  // when the version in place was typed last [ms]

  get now(): Version | undefined {
    return this.versions[this.place];
  }
  get canUndo(): boolean {
    return this.place > 0;
  }
  get canRedo(): boolean {
    return this.place + 1 < this.versions.length;
  }

  add(file: SharedFile, renamed: [string, string][] = []): void {
    this.typed = -Infinity;
    this.versions.length = this.place + 1;
    this.versions.push({file, renamed});
    let size = this.versions.reduce((sum, version) => sum + version.file.text.length, 0);
    while (this.versions.length > 2 && (this.versions.length > mostVersions || size > mostText)) size -= this.versions.shift()!.file.text.length;
    this.place = this.versions.length - 1;
  }

  /// Takes what is typed at a time [ms].
  type(file: SharedFile, at: number, rest: number): void {
    if (at - this.typed < rest && this.place > 0 && !this.canRedo) this.versions[this.place] = {file, renamed: []};
    else this.add(file);
    this.typed = at;
  }

  /// The version before, with what its names are to those of now.
  undo(): Version | undefined {
    if (!this.canUndo) return undefined;
    const renamed = this.versions[this.place--]!.renamed.map(([before, now]): [string, string] => [now, before]).reverse();
    this.typed = -Infinity;
    return {file: this.now!.file, renamed};
  }
  redo(): Version | undefined {
    if (!this.canRedo) return undefined;
    ++this.place;
    this.typed = -Infinity;
    return this.now;
  }
}

/// Names that changed once, and then again.
export function thenRenamed(first: [string, string][], second: [string, string][]): [string, string][] {
  let all = first;
  for (const [before, now] of second) {
    const chained = all.some(([, name]) => name === before);
    all = chained ? all.map(([old, name]): [string, string] => [old, name === before ? now : name]) : [...all, [before, now]];
  }
  return all.filter(([before, now]) => before !== now);
}
