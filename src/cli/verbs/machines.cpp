// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include <oblique/diagram/diagram.h>

#include <oblique/report/json_text.h>
#include <oblique/report/machine_list.h>
#include "terminal/terminal.h"
#include "verbs/command.h"

namespace oblique::cli {

ExitStatus show_machines(const Session&, const MachinesRequest& request) {
  if (request.name.empty()) {
    if (request.json) {
      nlohmann::ordered_json all = nlohmann::ordered_json::array();
      for (const std::string& name : diagram::machine_names())
        all.push_back(report::to_json(*diagram::find_machine(name)));
      print(report::json_text(all));
    } else {
      print(report::machine_list(command_line()));
    }
    return ExitStatus::done;
  }
  const diagram::MachineProfile* const machine = diagram::find_machine(request.name);
  if (machine == nullptr) throw diagram::DiagramError(diagram::unknown_machine(request.name));
  print(request.json ? report::json_text(report::to_json(*machine))
                     : report::to_text(*machine, diagram::BlockLibrary::shipped()));
  return ExitStatus::done;
}

}  // namespace oblique::cli
