// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

namespace oblique::mechanism {

/// Something that happens to a group on the way.
struct MotionEvent {
  enum class Kind {
    limit,     ///< a dead centre beyond which the group cannot be assembled
    return_,   ///< from beyond it, onto the same branch
    change,    ///< two of its modes cross: it passes by its velocity
    infinity,  ///< its links go away without end, and come back from the other side
    lost,      ///< no step leads on, and that it is a limit is not proven
  };
  Kind kind = Kind::limit;
  double time = 0;        ///< [s]
  std::size_t group = 0;  ///< index in Structure::groups

  /// Whether no mechanism goes on there.
  bool ends() const { return kind == Kind::limit || kind == Kind::infinity || kind == Kind::lost; }
};

}  // namespace oblique::mechanism
