// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <oblique/diagram/diagram.h>
#include <oblique/report/expectation_check.h>

namespace oblique::report {

/// Whether these settings answer the question of the diagram's lesson.
bool is_answered(const diagram::Diagram& diagram, const std::vector<diagram::ParameterOverride>& settings);

/// "open    question: …", and how to answer it; nothing where the lesson asks none.
std::string open_question_text(const diagram::Diagram& diagram);

/// "right   question: …", or "wrong   question: …" with what the answer gives and the hint, a line each. What
/// it should give it does not say: the answer remains to be found.
std::string verdict_text(const diagram::LessonQuestion& question,
                         const std::vector<ExpectationResult>& results);

/// The step of a lesson, counted from 1. Throws DiagramError where there is none.
const diagram::LessonStep& lesson_step(const diagram::Diagram& diagram, int number);

}  // namespace oblique::report
