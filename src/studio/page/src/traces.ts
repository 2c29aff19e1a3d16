// SPDX-License-Identifier: MIT

/// What the scope remembers of some signals: the last `most` rows, in rings.
export class Traces {
  private readonly columns: Float64Array[];
  private begin = 0;
  private count = 0;

  constructor(readonly names: readonly string[], private readonly most: number) {
    this.columns = [new Float64Array(most), ...names.map(() => new Float64Array(most))];
  }

  get rows(): number {
    return this.count;
  }

  /// Takes rows of the time and the signals. A time that goes back (the machine begins again) ends what was before,
  /// unless it is to persist.
  add(numbers: Float64Array, persists: boolean): void {
    const width = this.columns.length;
    for (let k = 0; k + width <= numbers.length; k += width) {
      if (this.count > 0 && numbers[k]! < this.at(0, this.count - 1)) {
        if (persists) this.push((c) => (c === 0 ? numbers[k]! : NaN));  // the beam is dark on its way back
        else this.clear();
      }
      this.push((c) => numbers[k + c]!);
    }
  }

  at(column: number, row: number): number {
    return this.columns[column]![(this.begin + row) % this.most]!;
  }

  /// A column in the order of its rows.
  column(column: number): Float64Array {
    const of = this.columns[column]!, end = this.begin + this.count, out = new Float64Array(this.count);
    out.set(of.subarray(this.begin, Math.min(end, this.most)));
    if (end > this.most) out.set(of.subarray(0, end - this.most), this.most - this.begin);
    return out;
  }

  clear(): void {
    this.begin = this.count = 0;
  }

  csv(): string {
    const lines = [["t", ...this.names].map((name) => (/[",\n]/.test(name) ? `"${name.replaceAll('"', '""')}"` : name)).join(",")];
    for (let row = 0; row < this.count; ++row) lines.push(this.columns.map((_, c) => String(this.at(c, row))).join(","));
    return lines.join("\n") + "\n";
  }

  private push(value: (column: number) => number): void {
    const place = (this.begin + this.count) % this.most;
    this.columns.forEach((column, c) => { column[place] = value(c); });
    if (this.count < this.most) ++this.count;
    else this.begin = (this.begin + 1) % this.most;
  }
}
