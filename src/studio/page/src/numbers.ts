// SPDX-License-Identifier: MIT

/// A number to three digits, with a power of ten where it is very small or large.
export function rough(value: number): string {
  const size = Math.abs(value);
  return size !== 0 && (size < 1e-3 || size >= 1e5) ? value.toExponential(2) : String(Number(value.toPrecision(3)));
}

/// A number to six digits, as files write it: an infinite one is "inf".
export function short(value: number): string {
  if (Number.isFinite(value)) return String(Number(value.toPrecision(6)));
  return Number.isNaN(value) ? "nan" : value > 0 ? "inf" : "-inf";
}

/// A unit as it stands beside a number: none is the machine unit.
export function besideNumber(unit: string): string {
  return /^(machine unit|1)$/.test(unit) ? "" : unit.replace(/^machine unit(?=\/)/, "1");
}
