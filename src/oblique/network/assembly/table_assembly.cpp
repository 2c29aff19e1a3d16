// SPDX-License-Identifier: MIT
#include <oblique/network/assembly/table_assembly.h>

#include <algorithm>
#include <utility>

#include <oblique/network/assembly/switch_assembly.h>
#include <oblique/text/expression_printer.h>

namespace oblique::network {
namespace {

NodeId interpolate_by_segments(Assembly& a, std::size_t block, const text::Expression& call,
                               text::PointTable table) {
  ExpressionGraph& graph = a.network.graph;
  const auto [found, inserted] = a.table_index.try_emplace(std::pair(block, text::to_string(call)), kNone);
  if (inserted) {
    found->second = static_cast<std::uint32_t>(a.network.tables.size());
    a.network.tables.push_back(std::move(table));
    const auto segment = static_cast<std::uint32_t>(a.network.discrete_states.size());
    a.network.discrete_states.push_back({a.diagram.blocks[block].path + ": segment", 0});
    a.pending_tables.push_back(
        {block, call.operands[0], found->second, segment, a.diagram.blocks[block].place});
  }
  const std::uint32_t chosen = found->second;
  const NodeId number = graph.constant(chosen);
  const NodeId x = a.built_operand(block, call.operands[0]);
  const auto& pending = *std::find_if(a.pending_tables.begin(), a.pending_tables.end(),
                                      [&](const Assembly::PendingTable& p) { return p.table == chosen; });
  return graph.apply(Op::table_value, x, graph.discrete_state(pending.segment), number);
}

/// A table with a few jumps is one without them and a step at each: a step can be slid along.
NodeId interpolate(Assembly& a, std::size_t block, const text::Expression& call, text::PointTable table) {
  // A recording may have thousands, of the time, which slides along none.
  constexpr std::size_t kMostSteps = 32;
  const std::vector<double>& x = table.x;
  if (!std::is_sorted(x.begin(), x.end()) || x[0] == x[1] || x[x.size() - 2] == x.back()) {
    throw text::ExpressionError{call.column,
                                "the x of a table do not rise from point to point",
                                "x1 < x2 ≤ x3 < …, where two that are equal make a jump",
                                {}};
  }
  struct Step {
    double x, height;
  };
  std::vector<Step> steps;
  text::PointTable joined;
  double risen = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    if (k > 0 && x[k] == x[k - 1]) {
      steps.push_back({table.x[k], table.y[k] - table.y[k - 1]});
      risen += steps.back().height;
    } else {
      joined.x.push_back(table.x[k]);
      joined.y.push_back(table.y[k] - risen);
    }
  }
  const bool apart = !steps.empty() && steps.size() <= kMostSteps;
  NodeId sum = interpolate_by_segments(a, block, call, apart ? std::move(joined) : std::move(table));
  if (!apart) return sum;
  for (const Step& step : steps) {
    text::Expression at;
    at.number = step.x;
    text::Expression beyond;
    beyond.kind = text::Expression::Kind::greater_equal;
    beyond.operands = {call.operands[0], at};
    sum = a.network.graph.apply(Op::add, sum,
                                a.network.graph.apply(Op::multiply, a.network.graph.constant(step.height),
                                                      a.built_operand(block, beyond)));
  }
  return sum;
}

}  // namespace

NodeId interpolated(Assembly& a, std::size_t block, const text::Expression& call) {
  text::PointTable table;
  if (call.operands.size() == 2 && call.operands[1].kind == text::Expression::Kind::name) {
    const diagram::FlatBlock& flat = a.diagram.blocks[block];
    const auto parameter = flat.definition->find_parameter(call.operands[1].name);
    if (parameter && flat.definition->parameters[*parameter].points)
      return interpolate(a, block, call, flat.points[*parameter]);
  }
  if (call.operands.size() < 5 || call.operands.size() % 2 == 0) {
    throw text::ExpressionError{
        call.column,
        "table() has an incomplete point",
        "table(x, x1, y1, x2, y2, …), or table(x, points) with a parameter of kind points",
        {}};
  }
  for (std::size_t i = 1; i + 1 < call.operands.size(); i += 2) {
    const auto x = a.constant_value(block, call.operands[i]),
               y = a.constant_value(block, call.operands[i + 1]);
    if (!x || !y)
      throw text::ExpressionError{
          call.column, "a point of the table varies", "points of numbers and parameters", {}};
    table.x.push_back(*x);
    table.y.push_back(*y);
  }
  return interpolate(a, block, call, std::move(table));
}

void define_tables(Assembly& a) {
  ExpressionGraph& graph = a.network.graph;
  std::size_t next_table = 0;
  while (next_table < a.pending_tables.size()) {
    const Assembly::PendingTable pending = a.pending_tables[next_table++];
    const NodeId x = a.built(pending.block, pending.x, pending.place, "a table's argument");
    const NodeId number = graph.constant(pending.table);
    const NodeId segment = graph.discrete_state(pending.segment);
    const NodeId found = graph.apply(Op::table_segment, x, number);
    for (const bool up : {true, false}) {
      const NodeId edge = graph.apply(up ? Op::table_end : Op::table_begin, segment, number);
      Switch made;
      made.discrete_state = a.new_discrete_state({}, 0);
      made.block = a.diagram.blocks[pending.block].path;
      made.comparison = text::to_string(pending.x) + (up ? " after its segment" : " before its segment");
      made.event_function = up ? graph.apply(Op::subtract, x, edge) : graph.apply(Op::subtract, edge, x);
      made.turning = Turning::bends;
      made.moves_along = a.network.events.size();
      // At least to the next one, which rounding may hide from the search.
      const NodeId next = graph.apply(up ? Op::add : Op::subtract, segment, graph.constant(1));
      const NodeId farther = up ? graph.apply(Op::less, next, found) : graph.apply(Op::less, found, next);
      Event event;
      event.block = made.block;
      event.condition = graph.discrete_state(made.discrete_state);
      event.repeats = true;
      event.actions.push_back({false, pending.segment, graph.apply(Op::select, farther, found, next)});
      add_switch(a, std::move(made));
      a.network.events.push_back(std::move(event));
    }
  }
}

}  // namespace oblique::network
