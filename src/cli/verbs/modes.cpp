// SPDX-License-Identifier: MIT
#include <algorithm>

#include <fmt/format.h>

#include <oblique/mechanism/model/read_mechanism.h>

#include <oblique/mechanism/structure/structure.h>
#include <oblique/report/mode_list.h>
#include "terminal/terminal.h"
#include "verbs/command.h"
#include "verbs/drive_place.h"

namespace oblique::cli {

ExitStatus show_modes(const Session&, const ModesRequest& request) {
  const mechanism::Mechanism mechanism = mechanism::read_mechanism(request.mechanism);
  mechanism::Structure structure = mechanism::find_groups(mechanism);
  const report::ModesAt position =
      report::modes_at(mechanism, structure, time_option_at(mechanism, request.at));
  print(request.json ? report::to_json(mechanism, structure, position)
                     : report::to_text(mechanism, structure, position));
  for (const std::size_t g : position.undecided) {
    note(fmt::format(
        "the sketch picks no mode of {}: sketch one of its points as it lies in the mode you want\n",
        structure.groups[g].name));
  }
  if (!position.open) return ExitStatus::done;
  const bool all_close =
      std::all_of(position.groups.begin(), position.groups.end(), [&](const mechanism::GroupModes& group) {
        return structure.groups[group.group].assur_class < 2 || !group.modes.empty();
      });
  note(all_close ? "the mechanism does not come there from its start: it can only be assembled there anew\n"
                 : "the mechanism cannot be assembled there\n");
  return ExitStatus::no;
}

}  // namespace oblique::cli
