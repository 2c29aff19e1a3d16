// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

namespace oblique {

/// Index of a node of an ExpressionGraph; operands always have smaller indices than the nodes that use them.
using NodeId = std::uint32_t;

/// What a node computes from its operands.
enum class Op : std::uint8_t {
  constant,
  variable,
  add,
  subtract,
  multiply,
  divide,
  power,
  negate,
  sin,
  cos,
  tan,
  asin,
  acos,
  atan,
  atan2,
  exp,
  log,
  sqrt,
  hypot,
};

/// Number of operands of an operation: 0, 1 or 2.
int operand_count(Op op);

/// One node: an operation on up to two others, a constant, or a variable known by its number.
struct Node {
  Op op = Op::constant;
  NodeId a = 0;
  NodeId b = 0;
  double value = 0;            ///< of a constant
  std::uint32_t variable = 0;  ///< number of a variable
};

/// Expressions as a directed acyclic graph in which equal sub-expressions are one node. Constants are folded
/// and neutral operands dropped (x+0, x·1, x·0, x/1, x^1, x^2 = x·x, −−x) as the nodes are made.
class ExpressionGraph {
 public:
  NodeId constant(double value);
  NodeId variable(std::uint32_t number);

  /// Applies a unary or binary operation; `b` is ignored by unary ones.
  NodeId apply(Op op, NodeId a, NodeId b = 0);

  const Node& operator[](NodeId id) const { return nodes_[id]; }
  std::size_t size() const { return nodes_.size(); }

  bool is_constant(NodeId id) const { return nodes_[id].op == Op::constant; }
  bool is_constant(NodeId id, double value) const { return is_constant(id) && nodes_[id].value == value; }

  /// Partial derivatives of `root` with respect to every variable it depends on, by variable number, zeros
  /// left out. Reverse accumulation: the cost is proportional to the sub-graph below `root`. Adds nodes to
  /// the graph.
  std::vector<std::pair<std::uint32_t, NodeId>> gradient(NodeId root);

 private:
  struct Key {
    Op op;
    NodeId a, b;
    std::uint64_t bits;  ///< of a constant's value or a variable's number
    bool operator==(const Key&) const = default;
  };
  struct Hash {
    std::size_t operator()(const Key& key) const;
  };

  NodeId intern(const Node& node);
  NodeId simplified(Op op, NodeId a, NodeId b, bool& done);
  /// Partial derivative of a node by its first or second operand.
  NodeId partial(NodeId id, int operand);

  std::vector<Node> nodes_;
  std::unordered_map<Key, NodeId, Hash> index_;
};

/// The value of an operation on numbers.
double evaluate(Op op, double a, double b);

}  // namespace oblique
