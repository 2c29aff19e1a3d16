// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <oblique/network/program/program.h>
#include <oblique/report/text_table.h>
#include <oblique/solve/run.h>
#include <oblique/solve/static_test.h>
#include <oblique/text/diagnostic.h>

/// What a run says to people, part by part. Not installed.
namespace oblique::report {

/// Rows of a trajectory, evenly spread, the first and the last among them; the first `columns` columns.
Table rows_of(const solve::Trajectory& trajectory, std::size_t columns);

/// What switched, and when; `count` events in all, of which `events` were kept.
std::string events_text(const std::vector<solve::EventRecord>& events, long count);

/// Every element's output, and the derivatives of states.
std::string static_test_text(const std::vector<solve::StaticReading>& readings);

/// How much work the run was, and by which method and why: a line each.
std::string solver_text(const network::Program& program, const solve::Run& run,
                        const solve::RunOptions& options);

/// A line, and its remedy, for each warning.
std::string warnings_text(const solve::Run& run,
                          const text::Vocabulary& vocabulary = text::plain_vocabulary());

/// A line for each signal that left the machine unit; of a run that this ended, one.
std::string overloads_text(const network::Program& program, const solve::Run& run);

/// The estimate of the outputs' errors.
std::string trust_text(const solve::Trust& trust);

}  // namespace oblique::report
