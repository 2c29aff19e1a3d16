// SPDX-License-Identifier: MIT
#pragma once

#include <utility>

#include <oblique/text/diagnostic.h>

namespace oblique::patch {

/// Thrown by the `patch` stage: a mechanism that cannot be turned into a diagram.
class PatchError : public text::Error {
 public:
  enum class Kind {
    obstacle,  ///< the mechanism, or what its patch would do, stands in the way
    request,   ///< the options contradict the mechanism or each other
  };

  explicit PatchError(text::Diagnostic diagnostic, Kind kind = Kind::obstacle)
      : text::Error(std::move(diagnostic)), kind_(kind) {}

  Kind kind() const { return kind_; }

  /// Whether PatchOptions::force would patch it all the same.
  bool can_be_forced() const { return can_be_forced_; }
  PatchError&& forcible() && {
    can_be_forced_ = true;
    return std::move(*this);
  }

 private:
  Kind kind_;
  bool can_be_forced_ = false;
};

}  // namespace oblique::patch
