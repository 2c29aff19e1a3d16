// SPDX-License-Identifier: MIT
// Runs as soon as the worker's script is read, so that the worker starts while the browser reads the rest of the page.
import {newWorker} from "./carried";

globalThis.earlyWorker = newWorker();
