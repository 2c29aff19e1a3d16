// SPDX-License-Identifier: MIT
import {rough} from "../numbers";
import type {Loops} from "./answers";

const width = 460, height = 300, left = 34, right = 12, top = 14, bottom = 34;
const decades = 4;  // that are told apart on either side of 0

/// The sign times the decades above the least that is told apart.
function warp(value: number, unit: number): number {
  return Math.sign(value) * Math.log10(1 + Math.abs(value) / unit);
}

function powerText(exponent: number): string {
  return `10${[...String(exponent)].map((digit) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[Number(digit)] ?? "⁻").join("")}`;
}

/// The eigenvalues of the closed system in the complex plane, on scales of decades to both sides of 0. Those that grow are
/// filled triangles, those that decay rings, the problem's own squares; those of the moment are bold.
export function Plane({loops, time}: {loops: Loops; time: number}) {
  const {numbers, columns, rows} = loops;
  const stride = columns.length;
  const at = (row: number, column: number) => numbers[row * stride + column]!;
  let largest = 0, nearest = NaN;
  for (let row = 0; row < rows; ++row) {
    largest = Math.max(largest, Math.abs(at(row, 2)), Math.abs(at(row, 3)));
    if (!(Math.abs(at(row, 0) - time) >= Math.abs(nearest - time))) nearest = at(row, 0);
  }
  const top10 = Math.ceil(Math.log10(Math.max(largest, 1e-300))), unit = 10 ** (top10 - decades), most = warp(10 ** top10, unit);
  const x = (real: number) => left + (width - left - right) * (warp(real, unit) + most) / (2 * most);
  const y = (imaginary: number) => top + (height - top - bottom) * (1 - (warp(imaginary, unit) + most) / (2 * most));
  const ticks = Array.from({length: decades}, (_, k) => top10 - decades + 1 + k);
  const marks = [];
  for (let row = 0; row < rows; ++row) {
    const real = at(row, 2), imaginary = at(row, 3), isNow = at(row, 0) === nearest, own = at(row, 5) === 1, grows = real > 0 && !own;
    const kind = `pole ${own ? "own" : grows ? "grows" : "decays"} ${isNow ? "now" : ""}`;
    for (const sign of imaginary === 0 ? [1] : [1, -1]) {
      const px = x(real), py = y(sign * imaginary), size = isNow ? 5 : 3;
      marks.push(grows ? <path class={kind} d={`M${px} ${py - size * 1.3}l${size * 1.2} ${size * 2.2}h${-size * 2.4}z`} />
        : own ? <rect class={kind} x={px - size / 1.4} y={py - size / 1.4} width={size * 1.4} height={size * 1.4} />
        : <circle class={kind} cx={px} cy={py} r={size} />);
    }
  }
  return (
    <svg class="plane" viewBox={`0 0 ${width} ${height}`} role="img" aria-label={`Eigenvalues in the complex plane: ${loops.growing} of them grow`}>
      <rect class="right-half" x={x(0)} y={top} width={width - right - x(0)} height={height - top - bottom} />
      <rect class="frame" x={left} y={top} width={width - left - right} height={height - top - bottom} />
      <line class="axis" x1={x(0)} y1={top} x2={x(0)} y2={height - bottom} />
      <line class="axis" x1={left} y1={y(0)} x2={width - right} y2={y(0)} />
      {ticks.flatMap((exponent) => [-1, 1].map((sign) => (
        <g>
          <line class="grid" x1={x(sign * 10 ** exponent)} y1={top} x2={x(sign * 10 ** exponent)} y2={height - bottom} />
          <text x={x(sign * 10 ** exponent)} y={height - bottom + 14} text-anchor="middle">{sign < 0 ? "−" : ""}{powerText(exponent)}</text>
          <line class="grid" x1={left} y1={y(sign * 10 ** exponent)} x2={width - right} y2={y(sign * 10 ** exponent)} />
          <text x={left - 4} y={y(sign * 10 ** exponent) + 4} text-anchor="end">{sign < 0 ? "−" : ""}{powerText(exponent)}</text>
        </g>
      )))}
      {marks}
      <text x={width - right} y={height - 5} text-anchor="end">real part [1/s]</text>
      <text x={left} y={height - 5}>○ decays  ▲ grows  □ of the problem itself</text>
      <title>rightmost of the loops: {loops.rightmost ? rough(loops.rightmost.real) : "none"} 1/s</title>
    </svg>
  );
}
