// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include <oblique/text/operations.h>

namespace oblique::network {

/// Index of a node of an ExpressionGraph; operands always have smaller indices than the nodes that use them.
using NodeId = std::uint32_t;

/// What a node computes from its operands.
enum class Op : std::uint8_t {
  constant,
  variable,
  discrete_state,  ///< held between events: no derivative
// the smooth operations
#define OBLIQUE_OPERATION(name, ...) name,
#include <oblique/text/operations.def>
  select,  ///< a ≠ 0: b, else c; between b and c where 0 < a < 1 (a sliding switch)
  gate,    ///< a·b, and 0 where a is, even if b is no number: the way a derivative passes `select`
  less,    ///< 1 or 0; these three are for what changes with events only
  less_equal,
  equal,
  table_value,    ///< straight line of segment b of the table c at a
  table_slope,    ///< its slope; segment a of table b
  table_end,      ///< where segment a of table b ends; infinite for the last
  table_begin,    ///< where it begins; −infinite for the first
  table_segment,  ///< which segment of table b holds a
};

/// A smooth operation in the graph, and what of the graph is one.
Op op_of(text::Operation operation);
std::optional<text::Operation> smooth_operation(Op op);

/// Number of operands of an operation: 0 to 3.
int operand_count(Op op);

/// One node: an operation on up to three others, a constant, or a variable or discrete state known by its
/// number.
struct Node {
  Op op = Op::constant;
  NodeId a = 0;
  NodeId b = 0;
  NodeId c = 0;
  double value = 0;            ///< of a constant
  std::uint32_t variable = 0;  ///< number of a variable or discrete state; of a constant that follows from
                               ///< parameters that of its formula + 1
  bool continuous = false;     ///< depends on a variable: may change between events

  NodeId operand(int i) const { return i == 0 ? a : i == 1 ? b : c; }
};

/// What the equations owe to the value of a constant: nothing, its kind, or all of it.
enum class Decided : std::uint8_t { nothing, kind, value };

/// How a constant follows from parameters: it is one, or an operation on constants.
struct ConstantFormula {
  static constexpr std::uint32_t kNoParameter = std::numeric_limits<std::uint32_t>::max();

  NodeId node = 0;  ///< of the constant
  Op op = Op::constant;
  NodeId a = 0, b = 0;
  std::uint32_t parameter = kNoParameter;  ///< its number
  bool held = false;                       ///< it follows from a held parameter
  Decided decided = Decided::kind;
};

/// What simplification looks at in a constant.
enum class ConstantKind : std::uint8_t {
  no_number,
  minus_infinity,
  negative,
  minus_one,
  zero,
  positive,
  one,
  two,
  infinity
};
ConstantKind kind_of(double value);

/// Whether what was decided by a constant stays when it gets another value.
bool stays(Decided decided, double before, double now);

/// Expressions as a directed acyclic graph in which equal sub-expressions are one node. Constants are folded
/// and neutral operands dropped (x+0, x·1, x·0, x/1, x^1, x^2 = x·x, −−x) as the nodes are made.
///
/// A constant that follows from parameters knows how: with other parameters the graph is the same one with
/// other numbers for as long as all that was decided by these constants stays. Two of them are one node where
/// their formulas are equal, not where their values are.
/// What follows from held parameters is not simplified by its value: of it only choices between cases decide.
class ExpressionGraph {
 public:
  ExpressionGraph() = default;
  /// With these parameters held.
  explicit ExpressionGraph(std::unordered_set<std::uint32_t> held) : held_(std::move(held)) {}

  NodeId constant(double value);
  /// A parameter, which may get another value when all is built: a constant by its number.
  NodeId parameter(std::uint32_t number, double value);
  NodeId variable(std::uint32_t number);
  NodeId discrete_state(std::uint32_t number);

  /// Applies an operation; the operands beyond its number are ignored. Operands that are tables are constants
  /// that hold the table's number.
  NodeId apply(Op op, NodeId a, NodeId b = 0, NodeId c = 0);

  const Node& operator[](NodeId id) const { return nodes_[id]; }
  std::size_t size() const { return nodes_.size(); }

  bool is_constant(NodeId id) const { return nodes_[id].op == Op::constant; }
  /// Whether it is 0, 1, −1 or 2, which its kind tells, and may be simplified by.
  bool is_constant(NodeId id, double value) const {
    return is_constant(id) && nodes_[id].value == value && !follows_held(id);
  }
  /// The value of a constant of which the kind decides.
  double value_of_kind(NodeId id) { return value_deciding(id, Decided::kind); }
  /// The value of a constant by which more is decided than its kind tells: freezes it.
  double frozen_value(NodeId id) { return value_deciding(id, Decided::value); }
  /// How a constant follows from parameters; nothing of one that does not, and of other nodes.
  const ConstantFormula* formula_of(NodeId id) const;
  /// A node; of a constant that is an operation on other ones, as if it were no constant.
  Node with_operands(NodeId id) const;
  /// Of all constants that follow from parameters, each after those that it needs.
  const std::vector<ConstantFormula>& formulas() const { return formulas_; }

  /// Partial derivatives of `root` with respect to every variable it depends on, by variable number, zeros
  /// left out. Reverse accumulation: the cost is proportional to the sub-graph below `root`. Adds nodes to
  /// the graph.
  std::vector<std::pair<std::uint32_t, NodeId>> gradient(NodeId root);

  /// Partial derivative of a node by one of its operands. Adds nodes to the graph.
  NodeId partial(NodeId id, int operand);
  /// Whether `derivative`, a partial derivative of a node, is a finite number wherever there is one at all.
  bool has_value_everywhere(NodeId id, NodeId derivative) const;

 private:
  struct Key {
    Op op;
    NodeId a, b, c;
    std::uint64_t bits;  ///< of a constant's value or a variable's number
    bool operator==(const Key&) const = default;
  };
  struct Hash {
    std::size_t operator()(const Key& key) const;
  };

  bool follows_held(NodeId id) const {
    return nodes_[id].variable != 0 && formulas_[nodes_[id].variable - 1].held;
  }
  double value_deciding(NodeId id, Decided what);
  NodeId intern(const Node& node);
  NodeId intern(const ConstantFormula& formula, double value);
  NodeId folded(Op op, NodeId a, NodeId b);
  NodeId simplified(Op op, NodeId a, NodeId b, NodeId c, bool& done);
  /// adjoint · (partial derivative of a node by one of its operands).
  NodeId passed_on(NodeId adjoint, NodeId id, int operand);

  std::unordered_set<std::uint32_t> held_;
  std::vector<Node> nodes_;
  std::vector<ConstantFormula> formulas_;
  std::unordered_map<Key, NodeId, Hash> index_;
};

/// The value of an operation on up to two numbers; not of `select` and tables.
double evaluate(Op op, double a, double b);

/// The value of Op::select.
double select(double chosen, double b, double c);

}  // namespace oblique::network
