// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <oblique/diagram/block_library.h>
#include <oblique/text/diagnostic.h>

/// Blocks for people. Not installed.
namespace oblique::report {

/// The blocks that there are, a line each.
std::string block_list(const diagram::BlockLibrary& library,
                       const text::Vocabulary& vocabulary = text::plain_vocabulary());

/// All that is known of one: what it does, its ports and parameters, its definition.
std::string to_text(const diagram::BlockDefinition& block);

}  // namespace oblique::report
