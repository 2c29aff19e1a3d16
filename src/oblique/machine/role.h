// SPDX-License-Identifier: MIT
#pragma once

#include <initializer_list>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <oblique/diagram/block_library.h>
#include <oblique/diagram/flat_diagram.h>

namespace oblique::machine {

using diagram::Role;

/// Whether it is a factor alone: a potentiometer, or the gain of an input.
bool is_coefficient(Role role);
/// Whether it forms a product, a squarer of one signal with itself.
bool is_product(Role role);
/// Whether a machine takes it as it is: comparators, function generators, and what no machine has. Their
/// signals are carried as they are.
bool stays_as_it_is(Role role);

/// The block that a machine's elements of a role are written as. Throws RealiseError where the library has
/// none: a user may have put blocks without roles in the place of the shipped ones.
const diagram::BlockDefinition& element_block(const diagram::BlockLibrary& library, Role role);

/// A block of a machine's elements of a role that has its defaults, and nothing at its inputs. Throws as
/// `element_block`.
diagram::FlatBlock element(const diagram::BlockLibrary& library, Role role, std::string path,
                           const text::Place& place);

/// Whether the block's parameters, but those of the names given, have their defaults: whether it is free of
/// imperfections of its own.
bool has_defaults(const diagram::FlatBlock& block, std::initializer_list<std::string_view> but = {});

/// The value of a parameter of the block; the definition must have it.
double parameter_of(const diagram::FlatBlock& block, std::string_view name);

/// Numbers elements as a patch panel does: A1, A2 … amplifiers, P1 … potentiometers, M1 … multipliers, K1 …
/// comparators, F1 … function generators, X1 … others; nothing for a reference.
class ElementNumbers {
 public:
  /// That of the next block of this role.
  std::string next(Role role);

 private:
  std::map<char, int> last_;
};

/// Those of a diagram's blocks; +REF and −REF are the reference.
std::vector<std::string> element_numbers(const diagram::FlatDiagram& diagram);

}  // namespace oblique::machine
