// SPDX-License-Identifier: MIT
// Exceptions of the library as those of Python, with the same fields.
#include "binding.h"

#include <oblique/console/console.h>
#include <oblique/ensemble/plan/plan_file.h>
#include <oblique/ensemble/study/study.h>
#include <oblique/machine/realise.h>
#include <oblique/network/assembly/network.h>
#include <oblique/solve/solve_error.h>
#include <oblique/synthesis/synthesis_error.h>

namespace oblique::python {
namespace {

void raise(const char* type, const std::vector<text::Diagnostic>& diagnostics, const char* kind = nullptr,
           const py::object& time = py::none()) {
  const py::object exception = py::module_::import("oblique._errors").attr(type);
  const py::object named = kind == nullptr ? py::object(py::none()) : py::str(kind);
  const py::object made = exception.attr("_from_library")(to_list(diagnostics), named, time);
  PyErr_SetObject(exception.ptr(), made.ptr());
}

/// With the remedy that the caller has beside those of the message.
std::vector<text::Diagnostic> diagnostics_of(const patch::PatchError& error) {
  std::vector<text::Diagnostic> diagnostics = error.diagnostics();
  if (error.can_be_forced())
    diagnostics.front().remedy +=
        text::Remedy{"; ", text::Setting{"force", "True"}, " writes this one all the same"};
  return diagnostics;
}

const char* name_of(solve::SolveError::Kind kind) {
  switch (kind) {
    case solve::SolveError::Kind::singular_loop:
      return "singular_loop";
    case solve::SolveError::Kind::no_rest:
      return "no_rest";
    case solve::SolveError::Kind::blow_up:
      return "blow_up";
    case solve::SolveError::Kind::step_budget:
      return "step_budget";
    case solve::SolveError::Kind::chatter:
      return "chatter";
    case solve::SolveError::Kind::other:
      return "other";
  }
  return "other";
}

const char* name_of(mechanism::MechanismError::Kind kind) {
  switch (kind) {
    case mechanism::MechanismError::Kind::file:
      return "file";
    case mechanism::MechanismError::Kind::request:
      return "request";
    case mechanism::MechanismError::Kind::mobility:
      return "mobility";
    case mechanism::MechanismError::Kind::constraint:
      return "constraint";
    case mechanism::MechanismError::Kind::sketch:
      return "sketch";
    case mechanism::MechanismError::Kind::assembly:
      return "assembly";
  }
  return "file";
}

void translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const solve::SolveError& error) {
    raise("SolveError", error.diagnostics(), name_of(error.kind()), py::float_(error.time()));
  } catch (const mechanism::MechanismError& error) {
    raise("MechanismError", error.diagnostics(), name_of(error.kind()));
  } catch (const patch::PatchError& error) {
    raise("PatchError", diagnostics_of(error),
          error.kind() == patch::PatchError::Kind::obstacle ? "obstacle" : "request");
  } catch (const synthesis::SynthesisError& error) {
    raise("SynthesisError", error.diagnostics(),
          error.kind() == synthesis::SynthesisError::Kind::nowhere ? "nowhere" : "request");
  } catch (const diagram::DiagramError& error) {
    raise("DiagramError", error.diagnostics());
  } catch (const network::NetworkError& error) {
    raise("NetworkError", error.diagnostics());
  } catch (const machine::RealiseError& error) {
    raise("RealiseError", error.diagnostics());
  } catch (const console::ConsoleError& error) {
    raise("ConsoleError", error.diagnostics());
  } catch (const ensemble::PlanError& error) {
    raise("PlanError", error.diagnostics());
  } catch (const ensemble::StudyError& error) {
    raise("PlanError", error.diagnostics());
  } catch (const text::ReadError& error) {
    raise("ReadError", error.diagnostics());
  } catch (const text::Error& error) {
    raise("Error", error.diagnostics());
  }
}

}  // namespace

void bind_errors(py::module_&) {
  py::register_exception_translator(translate);
}

}  // namespace oblique::python
