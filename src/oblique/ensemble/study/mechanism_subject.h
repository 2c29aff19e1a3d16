// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include <oblique/diagram/block_library.h>
#include <oblique/ensemble/study/plan.h>
#include <oblique/ensemble/study/subject.h>

// Of this stage; not installed.
namespace oblique::ensemble {

/// `text` is that of the mechanism. Throws what reading and patching it throws.
std::unique_ptr<Subject> mechanism_subject(const Plan& plan, const std::string& text,
                                           const diagram::BlockLibrary& library);

}  // namespace oblique::ensemble
