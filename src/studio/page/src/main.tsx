// SPDX-License-Identifier: MIT
import {render} from "preact";

import {App} from "./app";
import {scripting} from "./scripting";
import {Session} from "./session";

const session = new Session();
Object.assign(globalThis, {oblique: scripting(session)});
render(<App session={session} />, document.getElementById("studio")!);
