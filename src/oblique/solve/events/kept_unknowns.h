// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include <oblique/network/program/program.h>

namespace oblique::solve {

/// Puts the unknowns of all algebraic loops back where they were when this was made: who looks where the
/// solution may never come, next to the end of a branch say, leaves no loop on another branch. Not installed.
class KeptUnknowns {
 public:
  KeptUnknowns(const network::Program& program, network::Workspace& workspace) : workspace_(workspace) {
    for (std::size_t u = 0; u < program.unknowns().size(); ++u) unknowns_.push_back(workspace.unknown(u));
  }
  ~KeptUnknowns() {
    for (std::size_t u = 0; u < unknowns_.size(); ++u) workspace_.set_unknown(u, unknowns_[u]);
  }
  KeptUnknowns(const KeptUnknowns&) = delete;
  KeptUnknowns& operator=(const KeptUnknowns&) = delete;

 private:
  network::Workspace& workspace_;
  std::vector<double> unknowns_;
};

}  // namespace oblique::solve
