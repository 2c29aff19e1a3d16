// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <oblique/diagram/diagram.h>

#include <oblique/report/block_page.h>
#include "terminal/terminal.h"
#include "verbs/command.h"

namespace oblique::cli {

ExitStatus show_blocks(const Session& session, const BlocksRequest& request) {
  const diagram::BlockLibrary library = session.blocks();
  if (request.name.empty()) {
    print(report::block_list(library, command_line()));
    return ExitStatus::done;
  }
  const diagram::BlockDefinition* const block = library.find(request.name);
  if (block == nullptr) {
    throw diagram::DiagramError(text::Diagnostic{{},
                                                 fmt::format("there is no block '{}'", request.name),
                                                 {},
                                                 text::suggest(request.name, library.names())});
  }
  print(report::to_text(*block));
  return ExitStatus::done;
}

}  // namespace oblique::cli
