// SPDX-License-Identifier: MIT
// A file in the fragment of a link: its name and its text, compressed. A fragment is sent nowhere.

async function through(stream: CompressionStream | DecompressionStream, bytes: Uint8Array): Promise<Uint8Array> {
  const out = new Blob([bytes as BlobPart]).stream().pipeThrough(stream as ReadableWritablePair<Uint8Array, Uint8Array>);
  return new Uint8Array(await new Response(out).arrayBuffer());
}

interface Named {
  name: string;
  text: string;
}

/// A diagram or a mechanism, and what it needs beside it: files that it names, kinds of blocks of its own.
export interface SharedFile extends Named {
  files?: Named[];
  blocks?: Named[];
}

export async function toFragment(file: SharedFile): Promise<string> {
  const zipped = await through(new CompressionStream("deflate-raw"), new TextEncoder().encode(JSON.stringify(file)));
  let text = "";
  for (const byte of zipped) text += String.fromCharCode(byte);
  return "#" + btoa(text).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
}

/// Nothing where the fragment holds no file.
export async function fromFragment(fragment: string): Promise<SharedFile | undefined> {
  if (fragment.length < 2) return undefined;
  try {
    const text = atob(fragment.slice(1).replaceAll("-", "+").replaceAll("_", "/"));
    const zipped = Uint8Array.from(text, (c) => c.charCodeAt(0));
    const file = JSON.parse(new TextDecoder().decode(await through(new DecompressionStream("deflate-raw"), zipped)));
    return typeof file.text === "string" && typeof file.name === "string" ? file : undefined;
  } catch {
    return undefined;
  }
}

export function save(name: string, content: BlobPart, type: string): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([content], {type}));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}
