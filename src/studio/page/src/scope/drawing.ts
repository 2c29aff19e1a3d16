// SPDX-License-Identifier: MIT
// A picture as data, and its two writers: the canvas that is looked at and the SVG that is saved.

export type Ink = "paper" | "ink" | "faint" | "quiet" | number;  ///< a number: of a trace

interface Themed {
  paper: string;
  ink: string;
  faint: string;
  quiet: string;
  traces: readonly string[];
}

/// The accents can be told apart by colour-blind people (M. Okabe, K. Ito, "Color universal design", 2008).
export const themes: Record<"light" | "dark", Themed> = {
  light: {paper: "#ffffff", ink: "#1d1d1b", faint: "#d8d4ca", quiet: "#6b675e", traces: ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#b98000", "#3a9bdc", "#8a7a00", "#707070"]},
  dark: {paper: "#17181a", ink: "#e8e6e1", faint: "#3a3d42", quiet: "#a09c93", traces: ["#4aa8e0", "#f0803c", "#2cc79b", "#e09cc4", "#f2b632", "#86ccf2", "#f0e442", "#b0b0b0"]},
};
export type Theme = keyof typeof themes;

export function colourOf(ink: Ink, theme: Theme): string {
  const of = themes[theme];
  return typeof ink === "number" ? of.traces[ink % of.traces.length]! : of[ink];
}

/// Traces beyond the colours are dashed.
export function dashOf(ink: Ink): number[] {
  const round = typeof ink === "number" ? Math.floor(ink / themes.light.traces.length) : 0;
  return round === 0 ? [] : round === 1 ? [6, 3] : [2, 3];
}

/// x and y in turn [px]; NaN lifts the pen.
export interface Line {
  points: readonly number[];
  ink: Ink;
  width: number;
  opacity: number;
  dash?: readonly number[];
}

export interface Disc {
  x: number;
  y: number;
  radius: number;
  ink: Ink;
}

export interface Label {
  x: number;
  y: number;  ///< of the baseline
  text: string;
  anchor: "start" | "middle" | "end";
  ink: Ink;
  size: number;
  upwards?: boolean;
  halo?: boolean;  ///< of the paper's colour, where it stands over lines
}

export interface Frame {
  x: number;
  y: number;
  width: number;
  height: number;
}

export interface Drawing {
  width: number;
  height: number;
  title: string;
  description: string;
  frame: Frame;
  lines: Line[];   ///< those of the grid first; what leaves the frame is cut off
  discs: Disc[];
  labels: Label[];
}

const family = "Helvetica, Arial, 'Liberation Sans', 'DejaVu Sans', sans-serif";

let measuring: CanvasRenderingContext2D | undefined;
export function widthOf(text: string, size: number): number {
  measuring ??= document.createElement("canvas").getContext("2d")!;
  measuring.font = `${size}px ${family}`;
  return measuring.measureText(text).width;
}

/// Draws on a canvas of the picture's size, `scale` pixels a unit.
export function paint(drawing: Drawing, canvas: HTMLCanvasElement, theme: Theme, scale: number): void {
  const width = Math.round(drawing.width * scale), height = Math.round(drawing.height * scale);
  if (canvas.width !== width) canvas.width = width;
  if (canvas.height !== height) canvas.height = height;
  const pen = canvas.getContext("2d")!;
  pen.setTransform(scale, 0, 0, scale, 0, 0);
  pen.globalAlpha = 1;
  pen.fillStyle = colourOf("paper", theme);
  pen.fillRect(0, 0, drawing.width, drawing.height);
  const {frame} = drawing;
  pen.save();
  pen.beginPath();
  pen.rect(frame.x, frame.y, frame.width, frame.height);
  pen.clip();
  pen.lineJoin = "round";
  for (const line of drawing.lines) {
    pen.strokeStyle = colourOf(line.ink, theme);
    pen.lineWidth = line.width;
    pen.globalAlpha = line.opacity;
    pen.setLineDash([...(line.dash ?? [])]);
    pen.beginPath();
    let down = false;
    for (let k = 0; k + 1 < line.points.length; k += 2) {
      const x = line.points[k]!, y = line.points[k + 1]!;
      if (Number.isNaN(x) || Number.isNaN(y)) down = false;
      else if (down) pen.lineTo(x, y);
      else {
        pen.moveTo(x, y);
        down = true;
      }
    }
    pen.stroke();
  }
  pen.restore();
  pen.setLineDash([]);
  pen.globalAlpha = 1;
  pen.strokeStyle = colourOf("quiet", theme);
  pen.lineWidth = 1;
  pen.strokeRect(frame.x, frame.y, frame.width, frame.height);
  for (const disc of drawing.discs) {
    pen.fillStyle = colourOf(disc.ink, theme);
    pen.beginPath();
    pen.arc(disc.x, disc.y, disc.radius, 0, 2 * Math.PI);
    pen.fill();
  }
  for (const label of drawing.labels) {
    pen.fillStyle = colourOf(label.ink, theme);
    pen.font = `${label.size}px ${family}`;
    pen.textAlign = label.anchor === "middle" ? "center" : label.anchor;
    if (label.upwards) {
      pen.save();
      pen.translate(label.x, label.y);
      pen.rotate(-Math.PI / 2);
      pen.fillText(label.text, 0, 0);
      pen.restore();
    } else {
      if (label.halo) {
        pen.strokeStyle = colourOf("paper", theme);
        pen.lineWidth = 3;
        pen.strokeText(label.text, label.x, label.y);
      }
      pen.fillText(label.text, label.x, label.y);
    }
  }
}

function escaped(text: string): string {
  return text.replace(/[\u0000-\u0008\u000b\u000c\u000e-\u001f\ufffe\uffff]/g, "").replaceAll("&", "&amp;").replaceAll("<", "&lt;").replaceAll(">", "&gt;").replaceAll('"', "&quot;");
}

const rounded = (value: number) => String(Math.round(value * 100) / 100 + 0);

/// The same picture as SVG 1.1, without anything from elsewhere.
export function toSvg(drawing: Drawing, theme: Theme): string {
  const {frame, width, height} = drawing;
  const paths = drawing.lines.map((line) => {
    let path = "", down = false;
    for (let k = 0; k + 1 < line.points.length; k += 2) {
      const x = line.points[k]!, y = line.points[k + 1]!;
      if (Number.isNaN(x) || Number.isNaN(y)) {
        down = false;
      } else {
        path += `${down ? "L" : "M"}${rounded(x)} ${rounded(y)}`;
        down = true;
      }
    }
    const opacity = line.opacity === 1 ? "" : ` stroke-opacity="${rounded(line.opacity)}"`;
    const dash = line.dash?.length ? ` stroke-dasharray="${line.dash.join(" ")}"` : "";
    return `<path d="${path}" stroke="${colourOf(line.ink, theme)}" stroke-width="${line.width}"${opacity}${dash}/>`;
  });
  const discs = drawing.discs.map((disc) => `<circle cx="${rounded(disc.x)}" cy="${rounded(disc.y)}" r="${disc.radius}" fill="${colourOf(disc.ink, theme)}"/>`);
  const labels = drawing.labels.map((label) => {
    const at = `x="${rounded(label.x)}" y="${rounded(label.y)}"`;
    const turned = label.upwards ? ` transform="rotate(-90 ${rounded(label.x)} ${rounded(label.y)})"` : "";
    const halo = label.halo ? ` stroke="${colourOf("paper", theme)}" stroke-width="3" paint-order="stroke"` : "";
    return `<text${halo} ${at} font-size="${label.size}" text-anchor="${label.anchor}" fill="${colourOf(label.ink, theme)}"${turned}>${escaped(label.text)}</text>`;
  });
  const box = `x="${rounded(frame.x)}" y="${rounded(frame.y)}" width="${rounded(frame.width)}" height="${rounded(frame.height)}"`;
  return [
    `<svg xmlns="http://www.w3.org/2000/svg" width="${rounded(width)}" height="${rounded(height)}" viewBox="0 0 ${rounded(width)} ${rounded(height)}" role="img" font-family="${family}">`,
    `<title>${escaped(drawing.title)}</title>`,
    `<desc>${escaped(drawing.description)}</desc>`,
    `<rect width="${rounded(width)}" height="${rounded(height)}" fill="${colourOf("paper", theme)}"/>`,
    `<clipPath id="screen"><rect ${box}/></clipPath>`,
    `<g clip-path="url(#screen)" fill="none" stroke-linejoin="round">`, ...paths, "</g>",
    `<rect ${box} fill="none" stroke="${colourOf("quiet", theme)}"/>`,
    ...discs, ...labels, "</svg>", "",
  ].join("\n");
}
