// SPDX-License-Identifier: MIT
#include <algorithm>
#include <exception>
#include <new>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include <oblique/mechanism/model/mechanism.h>
#include <oblique/patch/patch.h>
#include <oblique/solve/solve_error.h>
#include <oblique/synthesis/synthesis_error.h>

#include "arguments.h"
#include "terminal/memory.h"
#include "terminal/signals.h"
#include "terminal/terminal.h"

namespace oblique::cli {
namespace {

/// The first findings, in the order of the file: who has more mends these first.
ExitStatus report(const text::Error& error, ExitStatus status) {
  constexpr std::size_t kMostFindings = 20;
  const std::vector<text::Diagnostic>& all = error.diagnostics();
  const std::size_t shown = std::min(all.size(), kMostFindings);
  for (std::size_t i = 0; i < shown; ++i) print_error(message(all[i]));
  if (shown < all.size()) print_error(fmt::format("… and {} more", all.size() - shown));
  return status;
}

ExitStatus run_program(int argc, char** argv) {
  Chosen chosen;
  if (const auto status = parse_arguments(argc, argv, chosen)) return *status;
  try {
    return chosen.work();
  } catch (const solve::SolveError& error) {
    return report(error, ExitStatus::solver_failed);
  } catch (const mechanism::MechanismError& error) {
    return report(error, error.kind() == mechanism::MechanismError::Kind::assembly ? ExitStatus::no
                                                                                   : ExitStatus::bad_request);
  } catch (const synthesis::SynthesisError& error) {
    return report(error, error.kind() == synthesis::SynthesisError::Kind::nowhere ? ExitStatus::no
                                                                                  : ExitStatus::bad_request);
  } catch (const patch::PatchError& error) {
    return report(
        error, error.kind() == patch::PatchError::Kind::obstacle ? ExitStatus::no : ExitStatus::bad_request);
  } catch (const text::Error& error) {
    return report(error, ExitStatus::bad_request);
  }
}

/// Whatever happens is said, except that memory ran out: that is thrown.
ExitStatus run_and_report(int argc, char** argv) {
  try {
    keep_stdout();
    const ExitStatus status = run_program(argc, argv);
    if (results_are_written()) return status;
    print_error(
        "the results could not be written to stdout\n"
        "  remedy: make room where they go, or give a file with -o");
    return ExitStatus::bad_request;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::system_error& error) {  // no thread, no more open files …
    print_error(
        fmt::format("the system refuses: {}\n  remedy: end other programs, or raise its limits (ulimit -a)",
                    error.code().message()));
    return ExitStatus::bad_request;
  } catch (const std::exception& error) {
    print_error(fmt::format("internal error: {}; please report it", error.what()));
    return ExitStatus::solver_failed;
  }
}

}  // namespace

diagram::BlockLibrary Session::blocks() const {
  diagram::BlockLibrary library = diagram::BlockLibrary::shipped();
  for (const auto& directory : block_directories) library.add_directory(directory);
  return library;
}

}  // namespace oblique::cli

int main(int argc, char** argv) {
  using namespace oblique::cli;
  try {
    guard_memory();
    end_in_order_on_signals();
    const ExitStatus status = run_and_report(argc, argv);
    if (!memory_ran_out()) return static_cast<int>(status);
  } catch (const std::bad_alloc&) {
  }
  print_no_memory();
  return static_cast<int>(ExitStatus::bad_request);
}
