// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/diagram/block_library.h>
#include <oblique/diagram/diagram.h>
#include <oblique/solve/run.h>

#include "studio/engine/answer.h"
#include "studio/engine/options.h"

namespace oblique::studio {

/// {"title", "text", "steps": [{"do", "guess", "set": [{"name", "value"}], "see", "checked"}], "question":
/// {"ask", "answer", "hint"} or null}: what a page shows of it. "checked" tells whether a step expects
/// anything.
Json lesson_of(const diagram::Lesson& lesson);

/// What a step (from 1) or the question expects, held against a run with these settings: {"met", "checks":
/// [{"what", "actual", "value", "within", "met"}]}. `how` has what bounds the run. Throws ReadError where the
/// diagram has no such step or question, and as a run does.
Json checked_lesson(const diagram::Diagram& diagram, const diagram::BlockLibrary& library,
                    const Options& options, solve::RunOptions how);

}  // namespace oblique::studio
