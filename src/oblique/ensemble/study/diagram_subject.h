// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <oblique/diagram/block_library.h>
#include <oblique/diagram/diagram.h>
#include <oblique/ensemble/study/plan.h>
#include <oblique/ensemble/study/subject.h>
#include <oblique/text/quantity.h>

// Of this stage; not installed.
namespace oblique::ensemble {

/// `text` is that of the diagram. Throws what reading and flattening it throws.
std::unique_ptr<Subject> diagram_subject(const Plan& plan, const std::string& text,
                                         const diagram::BlockLibrary& library);

/// The unit in which values of "c.gain", "C.gain" or "c.in[2]" are. Throws DiagramError where the diagram has
/// no such thing.
text::Unit unit_in(const diagram::Diagram& diagram, const diagram::BlockLibrary& library,
                   const std::string& name);

/// The output of that name, or one of the signal of that name; `outputs` are the names of all outputs. Throws
/// ExpressionError where there is neither.
diagram::OutputSpec output_called(const diagram::Diagram& diagram, const diagram::BlockLibrary& library,
                                  const std::string& name, const std::vector<std::string>& outputs);

}  // namespace oblique::ensemble
