// SPDX-License-Identifier: MIT
#include <oblique/text/table_format.h>

#include <bit>

#include <fmt/format.h>

namespace oblique::text {

static_assert(std::endian::native == std::endian::little,
              "the binary formats are written as they stand here");

std::string_view bytes_of(std::span<const double> numbers) {
  return {reinterpret_cast<const char*>(numbers.data()), numbers.size_bytes()};
}

std::string take_name(const std::string& name, std::set<std::string>& taken, std::size_t most) {
  std::string free = name.substr(0, most);
  for (int k = 1; !taken.insert(free).second; ++k) {
    const std::string number = fmt::format("_{}", k);
    free = name.substr(0, most - number.size()) + number;
  }
  return free;
}

}  // namespace oblique::text
