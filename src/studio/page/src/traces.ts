// SPDX-License-Identifier: MIT

/// What the scope remembers of some signals: the last `most` rows, in rings.
export class Traces {
  private readonly columns: Float64Array[];
  private begin = 0;
  private count = 0;
  private passed = 0;             // rows that were dropped
  private begins: number[] = [];  // of the runs: rows, those that were dropped counted

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
      const goesBack = this.count > 0 && numbers[k]! < this.at(0, this.count - 1);
      if (goesBack && !persists) this.clear();
      if (this.count === 0 || goesBack) this.begins.push(this.passed + this.count);
      this.push((c) => numbers[k + c]!);
    }
  }

  at(column: number, row: number): number {
    return this.columns[column]![(this.begin + row) % this.most]!;
  }

  /// A part of a column in the order of its rows.
  column(column: number, from: number, to: number): Float64Array {
    const of = this.columns[column]!, first = this.begin + from, last = this.begin + to, out = new Float64Array(to - from);
    if (last <= this.most) out.set(of.subarray(first, last));
    else if (first >= this.most) out.set(of.subarray(first - this.most, last - this.most));
    else {
      out.set(of.subarray(first, this.most));
      out.set(of.subarray(0, last - this.most), this.most - first);
    }
    return out;
  }

  /// The rows between two beginnings of the machine.
  runs(): {from: number; to: number}[] {
    return this.begins.map((begin, k) => ({from: Math.max(0, begin - this.passed), to: (this.begins[k + 1] ?? this.passed + this.count) - this.passed}))
      .filter(({from, to}) => to > from);
  }

  clear(): void {
    this.begin = this.count = this.passed = 0;
    this.begins = [];
  }

  private push(value: (column: number) => number): void {
    const place = (this.begin + this.count) % this.most;
    this.columns.forEach((column, c) => { column[place] = value(c); });
    if (this.count < this.most) {
      ++this.count;
    } else {
      this.begin = (this.begin + 1) % this.most;
      ++this.passed;
      while (this.begins.length > 1 && this.begins[1]! <= this.passed) this.begins.shift();
    }
  }
}
