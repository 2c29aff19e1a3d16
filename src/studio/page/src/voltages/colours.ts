// SPDX-License-Identifier: MIT
// The colours of voltages: blue below zero, orange above, grey between, which colour-blind people tell apart, and so does who sees
// light and dark alone the size. They are mixed in Oklab (B. Ottosson, "A perceptual color space for image processing", 2020), so
// that equal steps look equal.

type Triple = [number, number, number];

export const levels = 32;  ///< steps on either side of zero

const ends = {light: ["#0b4fb3", "#8c8c88", "#b23a00"], dark: ["#74b9ff", "#77777d", "#ffa366"]} as const;

function linear(hex: string): Triple {
  return [1, 3, 5].map((at) => {
    const part = parseInt(hex.slice(at, at + 2), 16) / 255;
    return part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4;
  }) as Triple;
}

function toOklab([r, g, b]: Triple): Triple {
  const l = Math.cbrt(0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b);
  const m = Math.cbrt(0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b);
  const s = Math.cbrt(0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b);
  return [0.2104542553 * l + 0.793617785 * m - 0.0040720468 * s, 1.9779984951 * l - 2.428592205 * m + 0.4505937099 * s, 0.0259040371 * l + 0.7827717662 * m - 0.808675766 * s];
}

function toHex([lightness, a, b]: Triple): string {
  const l = (lightness + 0.3963377774 * a + 0.2158037573 * b) ** 3;
  const m = (lightness - 0.1055613458 * a - 0.0638541728 * b) ** 3;
  const s = (lightness - 0.0894841775 * a - 1.291485548 * b) ** 3;
  const parts = [4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s, -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s, -0.0041960863 * l - 0.7034186147 * m + 1.707614701 * s];
  return "#" + parts.map((part) => {
    const gamma = part <= 0.0031308 ? 12.92 * part : 1.055 * part ** (1 / 2.4) - 0.055;
    return Math.round(Math.min(Math.max(gamma, 0), 1) * 255).toString(16).padStart(2, "0");
  }).join("");
}

function scale([low, middle, high]: readonly [string, string, string]): string[] {
  const [from, zero, to] = [low, middle, high].map((hex) => toOklab(linear(hex))) as [Triple, Triple, Triple];
  return Array.from({length: 2 * levels + 1}, (_, k) => {
    const at = (k - levels) / levels, end = at < 0 ? from : to, part = Math.abs(at);
    return toHex(zero.map((one, c) => one + (end[c]! - one) * part) as Triple);
  });
}

/// From −1 to 1 machine unit in 2·levels + 1 steps.
export const colours = {light: scale(ends.light), dark: scale(ends.dark)};

/// The step of a voltage [machine unit]; NaN for one that is not known.
export function stepOf(value: number): number {
  return Math.round(Math.min(Math.max(value, -1), 1) * levels) + levels;
}
