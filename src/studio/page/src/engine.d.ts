declare module "engine" {
  export function loadEngine(given: {createEngine: unknown; wasmBinary: Uint8Array; limits: object}): Promise<object>;
}
declare module "engine-glue" {
  const createEngine: unknown;
  export default createEngine;
}
