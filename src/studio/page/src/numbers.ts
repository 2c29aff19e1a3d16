// SPDX-License-Identifier: MIT

/// A number to six digits, as files write it: an infinite one is "inf".
export function short(value: number): string {
  if (Number.isFinite(value)) return String(Number(value.toPrecision(6)));
  return Number.isNaN(value) ? "nan" : value > 0 ? "inf" : "-inf";
}
