declare module "engine" {
  export function loadEngine(given: {createEngine: unknown; wasmBinary?: Uint8Array; wasmModule?: WebAssembly.Module; limits: object}): Promise<object>;
}
declare module "engine-glue" {
  const createEngine: unknown;
  export default createEngine;
}
