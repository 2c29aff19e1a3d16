// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <oblique/diagram/block_library.h>

#include "studio/engine/answer.h"
#include "studio/engine/options.h"

namespace oblique::studio {

/// The kinds of blocks that there are: {"blocks": [{"name", "title", "summary", "doc", "is_composite",
/// "inputs": [{"name", "sum", "optional", "doc"}], "outputs": [{"name", "doc"}], "parameters": [{"name",
/// "default", "unit", "range", "doc"}], "svg"}]}.
Json catalogue(const diagram::BlockLibrary& library);

/// A diagram that may be wrong, as a patch panel: {"svg", "origin", "blocks": [{"name", "type", "label",
/// "known", "is_composite", "place", "placed", "body", "settings", "wires": [{"port", "term", "text",
/// "signal", "weight", "at"}], "open": [{"port", "at"}], "outputs": [{"signal", "at"}]}], "moved": [{"name",
/// "at"}], "lost", "shown": [{"name", "signal"}], "until"}; lengths in px of the picture, "body" as x, y,
/// width and height. Options: "theme", "held" (the block that makes room for the others).
Json panel_of(const std::string& text, const std::string& name, const diagram::BlockLibrary& library,
              const Options& options);

/// {"svg"} of what is inside the composite "path".
Json inside_of(const std::string& text, const std::string& name, const diagram::BlockLibrary& library,
               const Options& options);

/// {"text", "added", "renamed": [[before, now]]} after "steps", one after the other; each has what
/// `DiagramEdit` takes:
/// {"do": "add", "type", "name"}, {"do": "remove", "block"}, {"do": "rename", "block", "name"}, {"do":
/// "connect", "signal", "block", "port", "weight"}, {"do": "disconnect" or "weigh", "block", "port", "term",
/// "weight"}, {"do": "set", "block", "key", "value"}, {"do": "head", "path", "value"}, {"do": "place",
/// "places": [{"name", "at"}]}, {"do": "show", "output", "signal"}. "added" means in a later step the block
/// that was added last.
Json edited(const std::string& text, const std::string& name, const diagram::BlockLibrary& library,
            const std::string& options);

}  // namespace oblique::studio
