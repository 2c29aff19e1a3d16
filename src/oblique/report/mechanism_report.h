// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <string>

#include <oblique/commission/judge.h>
#include <oblique/diagram/machine_profile.h>
#include <oblique/mechanism/model/mechanism.h>

#include <oblique/report/html_page.h>

namespace oblique::report {

/// The page that tells all about a mechanism: its drawing, groups and motion, and where it can be patched its
/// patch, the convergence, the stability of the loops, and with a machine what that needs of it.
struct MechanismReport {
  const mechanism::Mechanism& mechanism;
  const diagram::BlockLibrary& blocks;
  patch::PatchOptions options;                       ///< of the patch
  const diagram::MachineProfile* machine = nullptr;  ///< none: the page says nothing of machines
  std::function<void(double fraction)> progress;
  text::Vocabulary vocabulary = text::plain_vocabulary();

  /// Writes the page. What keeps the mechanism from being patched, and what a run of the patch fails at, is
  /// told in it. Throws as `examine`.
  HtmlPage page() const;
};

}  // namespace oblique::report
