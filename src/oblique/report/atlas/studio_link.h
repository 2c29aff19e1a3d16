// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace oblique::report {

/// What follows the address of the studio's page so that it opens with this diagram: "#" and, in the letters
/// of base64url (RFC 4648), a raw deflate stream (RFC 1951) of the JSON `{"name": …, "text": …}`, in stored
/// blocks, so that no compressor is needed. `text` is UTF-8.
std::string studio_fragment(const std::string& name, const std::string& text);

}  // namespace oblique::report
