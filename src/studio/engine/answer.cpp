// SPDX-License-Identifier: MIT
#include "studio/engine/answer.h"

#include <algorithm>
#include <exception>
#include <new>

#include <fmt/format.h>

#include <oblique/console/console.h>
#include <oblique/diagram/diagram.h>
#include <oblique/mechanism/model/mechanism.h>
#include <oblique/network/assembly/network.h>
#include <oblique/patch/patch_error.h>
#include <oblique/solve/solve_error.h>

namespace oblique::studio {
namespace {

constexpr std::size_t kMostFindings = 100;  // who has more mends these first

Answer refusal(const char* error, const std::vector<text::Diagnostic>& diagnostics) {
  Answer refused;
  refused.object["ok"] = false;
  refused.object["error"] = error;
  refused.object["diagnostics"] = to_json(diagnostics);
  return refused;
}

Answer refusal(const char* error, std::string what, std::string remedy) {
  return refusal(error, {text::Diagnostic{{}, std::move(what), {}, std::move(remedy)}});
}

const char* name_of(solve::SolveError::Kind kind) {
  using Kind = solve::SolveError::Kind;
  switch (kind) {
    case Kind::singular_loop:
      return "singular_loop";
    case Kind::no_rest:
      return "no_rest";
    case Kind::blow_up:
      return "blow_up";
    case Kind::step_budget:
      return "step_budget";
    case Kind::chatter:
      return "chatter";
    case Kind::other:
      break;
  }
  return "other";
}

const char* name_of(mechanism::MechanismError::Kind kind) {
  using Kind = mechanism::MechanismError::Kind;
  switch (kind) {
    case Kind::file:
      return "file";
    case Kind::request:
      return "request";
    case Kind::mobility:
      return "mobility";
    case Kind::constraint:
      return "constraint";
    case Kind::sketch:
      return "sketch";
    case Kind::assembly:
      break;
  }
  return "assembly";
}

Answer refusal_of(const std::exception_ptr& thrown) {
  try {
    std::rethrow_exception(thrown);
  } catch (const solve::SolveError& error) {
    Answer refused = refusal("SolveError", error.diagnostics());
    refused.object["kind"] = name_of(error.kind());
    refused.object["time"] = error.time();
    return refused;
  } catch (const mechanism::MechanismError& error) {
    Answer refused = refusal("MechanismError", error.diagnostics());
    refused.object["kind"] = name_of(error.kind());
    return refused;
  } catch (const patch::PatchError& error) {
    Answer refused = refusal("PatchError", error.diagnostics());
    refused.object["kind"] = error.kind() == patch::PatchError::Kind::obstacle ? "obstacle" : "request";
    refused.object["can_be_forced"] = error.can_be_forced();
    return refused;
  } catch (const diagram::DiagramError& error) {
    return refusal("DiagramError", error.diagnostics());
  } catch (const network::NetworkError& error) {
    return refusal("NetworkError", error.diagnostics());
  } catch (const console::ConsoleError& error) {
    return refusal("ConsoleError", error.diagnostics());
  } catch (const text::ReadError& error) {
    return refusal("ReadError", error.diagnostics());
  } catch (const text::Error& error) {
    return refusal("Error", error.diagnostics());
  } catch (const std::bad_alloc&) {
    return refusal("NoMemory", "the memory of the page is used up",
                   "ask for fewer rows, or a smaller diagram");
  } catch (const std::exception& error) {
    return refusal("InternalError", fmt::format("internal error: {}", error.what()), "please report it");
  } catch (...) {
    return refusal("InternalError", "internal error", "please report it");
  }
}

}  // namespace

Json to_json(const text::Diagnostic& diagnostic) {
  Json json;
  json["file"] = diagnostic.place.file;
  json["line"] = diagnostic.place.position.line;
  json["column"] = diagnostic.place.position.column;
  json["what"] = diagnostic.what;
  json["expected"] = diagnostic.expected;
  json["remedy"] = diagnostic.remedy.words();
  json["message"] = text::to_string(diagnostic);
  return json;
}

Json to_json(const std::vector<text::Diagnostic>& diagnostics) {
  Json list = Json::array();
  const std::size_t shown = std::min(diagnostics.size(), kMostFindings);
  for (std::size_t k = 0; k < shown; ++k) list.push_back(to_json(diagnostics[k]));
  if (shown < diagnostics.size())
    list.push_back(
        to_json(text::Diagnostic{{}, fmt::format("… and {} more", diagnostics.size() - shown), {}, {}}));
  return list;
}

Answer answer(const std::function<Answer()>& work) {
  std::exception_ptr thrown;
  try {
    Answer done = work();
    done.object["ok"] = true;
    return done;
  } catch (...) {
    thrown = std::current_exception();
  }
  return refusal_of(thrown);
}

std::string to_text(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace oblique::studio
