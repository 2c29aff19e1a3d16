// SPDX-License-Identifier: MIT
#include <oblique/ensemble/study/mechanism_subject.h>

#include <oblique/ensemble/study/study.h>

namespace oblique::ensemble {

std::unique_ptr<Subject> mechanism_subject(const Plan& plan, const std::string& /*text*/,
                                           const diagram::BlockLibrary& /*library*/) {
  throw StudyError(text::Diagnostic{{plan.subject, {}}, "a mechanism cannot be varied yet", {}, {}});
}

}  // namespace oblique::ensemble
