// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/text/diagnostic.h>

namespace oblique::synthesis {

/// Thrown by the `synthesis` stage; `kind` says which question went wrong.
class SynthesisError : public text::Error {
 public:
  enum class Kind {
    request,  ///< the path or the free dimensions make no sense with this mechanism
    nowhere,  ///< no mechanism within the bounds can be assembled and turns as the given one does
  };

  explicit SynthesisError(std::vector<text::Diagnostic> diagnostics) : text::Error(std::move(diagnostics)) {}
  SynthesisError(Kind kind, text::Diagnostic diagnostic) : text::Error(std::move(diagnostic)), kind_(kind) {}

  Kind kind() const { return kind_; }

 private:
  Kind kind_ = Kind::request;
};

}  // namespace oblique::synthesis
