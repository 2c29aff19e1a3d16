// SPDX-License-Identifier: MIT
#include <exception>

#include <fmt/format.h>

#include <oblique/mechanism/mechanism.h>
#include <oblique/patch/patch.h>
#include <oblique/solve/solve_error.h>

#include "arguments.h"
#include "terminal.h"

namespace oblique::cli {
namespace {

ExitStatus report(const Error& error, ExitStatus status) {
  for (const Diagnostic& diagnostic : error.diagnostics()) print_error(to_string(diagnostic));
  return status;
}

ExitStatus run_program(int argc, char** argv) {
  Chosen chosen;
  if (const auto status = parse_arguments(argc, argv, chosen)) return *status;
  try {
    return chosen.work();
  } catch (const SolveError& error) {
    return report(error, ExitStatus::solver_failed);
  } catch (const MechanismError& error) {
    return report(error,
                  error.kind() == MechanismError::Kind::assembly ? ExitStatus::no : ExitStatus::bad_request);
  } catch (const PatchError& error) {
    return report(error, ExitStatus::no);
  } catch (const Error& error) {
    return report(error, ExitStatus::bad_request);
  }
}

}  // namespace

BlockLibrary Session::library() const {
  BlockLibrary library = BlockLibrary::shipped();
  for (const auto& directory : block_directories) library.add_directory(directory);
  return library;
}

}  // namespace oblique::cli

int main(int argc, char** argv) {
  try {
    return static_cast<int>(oblique::cli::run_program(argc, argv));
  } catch (const std::exception& error) {
    oblique::cli::print_error(fmt::format("internal error: {}; please report it", error.what()));
    return static_cast<int>(oblique::cli::ExitStatus::solver_failed);
  }
}
